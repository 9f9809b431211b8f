// What is reckoned of sixteen cells of a group. Internal linkage: see cell_lanes_kernel.h.
#pragma once

#include "tables/cell_lanes_kernel.h"
#include "tables/group_cells.h"

#include <cmath>

namespace {

// Where a draw in a cell is told to lie is less than 2^-24 radians off.
constexpr double kAngleSteps = 0x1p8;
constexpr double kNeverSure = 0x1p-32; // a width of numbers for which AcdfGroupAxis::scale is 1

/// Where they lie in the tables: room for all lanes.
struct GroupBlock {
    AcdfGroupCell* cells;
    float* densities;
    std::uint8_t* boxes;
};

/// What is the same for all cells.
struct GroupGrid {
    const double *heights, *sines; ///< as of acdf::GroupCells
    double columns, rows, step[2]; ///< step: radians, of positions
    bool square;
};

/// What trigonometry tells of the rows of lanes.
struct GroupHeights {
    alignas(64) double height[kCellLanes] = {}; ///< the part of the solid angle that they make
    double sine[kCellLanes] = {};               ///< of the angle to the pole, where that is least
};

/// An axis of cells.
struct GroupAxisLanes {
    alignas(64) double low[kCellLanes], high[kCellLanes]; // numbers
    // How far a direction moves across, were it as fast everywhere as where it is fastest, and by what to divide
    // that.
    double reach[kCellLanes], slowness[kCellLanes];
    // What is left of numbers in the group: the first that leads to the cell, in steps of 2^-32; how many do; the
    // lower and the upper side of its box, in steps of 2^-8.
    double number[kCellLanes], width[kCellLanes], from[kCellLanes], to[kCellLanes];
    std::uint32_t side[2][kCellLanes];                // from and to, rounded down
    alignas(64) std::uint32_t low_number[kCellLanes]; // as of AcdfGroupAxis
    float scale[kCellLanes];
};

static inline void find_heights(const GroupGrid& grid, const CellLanes& in, GroupHeights& out) {
    for (int i = 0; i < in.count; ++i) {
        const std::uint32_t first = in.first[1][i], last = in.last[1][i];
        if (grid.square) {
            out.height[i] = 2.0 * steps_of(in, 1, i) / grid.rows; // acdf_grid_height
            out.sine[i] = 1.0;
        } else {
            const double from = grid.sines[first], to = grid.sines[last];
            out.height[i] = grid.heights[first] - grid.heights[last];
            out.sine[i] = to < from ? to : from;
        }
    }
}

static inline void measure_lanes(const GroupGrid& grid, const CellLanes& in, const GroupHeights& heights,
                                 GroupAxisLanes axes[2]) {
    for (int i = 0; i < kCellLanes; ++i) {
        axes[0].reach[i] = steps_of(in, 0, i) * grid.step[0];
        axes[1].reach[i] = grid.square ? steps_of(in, 1, i) * grid.step[1] : heights.height[i];
        axes[0].slowness[i] = 1.0;
        axes[1].slowness[i] = heights.sine[i];
    }
}

// No numbers are in the boxes of dark cells, and of those too narrow: the lower sides of these are above all, and
// the upper ones below.
static inline void place_lanes(const CellLanes& in, double group_low, double scale, GroupAxisLanes& axis) {
    const double drawn = group_low < 1.0 ? 1.0 : 0.0;
    for (int i = 0; i < kCellLanes; ++i) {
        const double low = (axis.low[i] - group_low) * scale, width = (axis.high[i] - axis.low[i]) * scale;
        const double lifted = 0.5 * (low + std::fabs(low)), within = lifted < 1.0 ? lifted : 1.0;
        const double steps = within * 0x1p32, end = (low + width) * 256.0, upper = end > 0.0 ? end : 0.0;
        const double numbers = in.from[i] < in.to[i] ? width * drawn : 0.0; // no "and": masks stay masks
        const bool told = numbers > 0.0, slow = axis.reach[i] <= kAngleSteps * numbers * axis.slowness[i];
        const double slow_width = slow ? width : kNeverSure;
        axis.number[i] = told ? (steps < 0x1p32 - 1.0 ? steps : 0x1p32 - 1.0) : 0.0;
        axis.width[i] = told ? slow_width : kNeverSure;
        axis.from[i] = told ? within * 256.0 : 255.0;
        axis.to[i] = told ? (upper < 255.0 ? upper : 255.0) : 0.0;
    }
}

static inline void round_lanes(GroupAxisLanes& axis) {
    for (int i = 0; i < kCellLanes; ++i) {
        const auto high = static_cast<std::int32_t>(axis.number[i] * 0x1p-16); // vectors convert to no more bits
        const auto low = static_cast<std::int32_t>(axis.number[i] - high * 0x1p16);
        axis.low_number[i] = static_cast<std::uint32_t>(high) << 16 | static_cast<std::uint32_t>(low);
        axis.side[0][i] = static_cast<std::uint32_t>(static_cast<std::int32_t>(axis.from[i]));
        axis.side[1][i] = static_cast<std::uint32_t>(static_cast<std::int32_t>(axis.to[i]));
        axis.scale[i] = static_cast<float>(0x1p-32 / axis.width[i]);
    }
}

#ifdef ACDF_SSE2
static inline void set_group_cells(const GroupAxisLanes axes[2], AcdfGroupCell* out) {
    auto* const to = reinterpret_cast<__m128i*>(out);
    for (int i = 0; i < kCellLanes; i += 4) {
        const __m128i low[2] = {four_words(axes[0].low_number + i), four_words(axes[1].low_number + i)};
        const __m128i scale[2] = {four_words(axes[0].scale + i), four_words(axes[1].scale + i)};
        const __m128i a[2] = {_mm_unpacklo_epi32(low[0], scale[0]), _mm_unpackhi_epi32(low[0], scale[0])};
        const __m128i b[2] = {_mm_unpacklo_epi32(low[1], scale[1]), _mm_unpackhi_epi32(low[1], scale[1])};
        for (int k = 0; k < 2; ++k) {
            _mm_storeu_si128(to + i + 2 * k, _mm_unpacklo_epi64(a[k], b[k]));
            _mm_storeu_si128(to + i + 2 * k + 1, _mm_unpackhi_epi64(a[k], b[k]));
        }
    }
}

// The low byte of each lane, less 128; `without` where no cell is.
static inline void set_group_bytes(const std::uint32_t* side, std::uint32_t less, int count, int without,
                                   std::uint8_t* out) {
    const __m128i byte = _mm_set1_epi32(0xFF), base = _mm_set1_epi32(static_cast<int>(less));
    const __m128i numbers = _mm_set_epi8(15, 14, 13, 12, 11, 10, 9, 8, 7, 6, 5, 4, 3, 2, 1, 0);
    const __m128i there = _mm_cmpgt_epi8(_mm_set1_epi8(static_cast<char>(count)), numbers);
    __m128i four[4];
    for (int i = 0; i < 4; ++i) four[i] = _mm_and_si128(_mm_sub_epi32(four_words(side + 4 * i), base), byte);
    const __m128i all = _mm_packus_epi16(_mm_packs_epi32(four[0], four[1]), _mm_packs_epi32(four[2], four[3]));
    const __m128i turned = _mm_xor_si128(all, _mm_set1_epi8(static_cast<char>(0x80)));
    _mm_storeu_si128(reinterpret_cast<__m128i*>(out),
                     _mm_or_si128(_mm_and_si128(there, turned),
                                  _mm_andnot_si128(there, _mm_set1_epi8(static_cast<char>(without)))));
}
#else
static inline void set_group_cells(const GroupAxisLanes axes[2], AcdfGroupCell* out) {
    for (int i = 0; i < kCellLanes; ++i)
        out[i] = {{{axes[0].low_number[i], axes[0].scale[i]}, {axes[1].low_number[i], axes[1].scale[i]}}};
}

static inline void set_group_bytes(const std::uint32_t* side, std::uint32_t less, int count, int without,
                                   std::uint8_t* out) {
    for (int i = 0; i < kCellLanes; ++i)
        out[i] =
            static_cast<std::uint8_t>(i < count ? (side[i] - less) ^ 0x80u : static_cast<std::uint32_t>(without));
}
#endif

static inline void set_group_boxes(const AcdfGroup& group, const CellLanes& in, const GroupAxisLanes axes[2],
                                   int count, std::uint8_t* boxes) {
    std::uint8_t* const positions = boxes + 4 * ACDF_GROUP_POSITIONS;
    for (int axis = 0; axis < 2; ++axis) {
        const std::uint32_t corner = group.first[axis];
        const int at = 2 * axis * kCellLanes, upper = at + kCellLanes;
        set_group_bytes(axes[axis].side[0], 0, count, 0x7F, boxes + at);
        set_group_bytes(axes[axis].side[1], 0, count, 0x80, boxes + upper);
        set_group_bytes(in.first[axis], corner, count, 0x7F, positions + at);
        set_group_bytes(in.last[axis], corner + 1, count, 0x80, positions + upper);
    }
}

// Of all lanes; boxes of as many as there are cells. Of a group of one cell the tables tell where it lies.
static inline void reckon_group_lanes(const GroupGrid& grid, const AcdfGroup& group, const CellLanes& in,
                                      GroupHeights& heights, const GroupBlock& out) {
    GroupAxisLanes axes[2];
    find_heights(grid, in, heights);
    narrow_lanes(in, axes);
    measure_lanes(grid, in, heights, axes);
    for (int axis = 0; axis < 2; ++axis) {
        place_lanes(in, group.low[axis], group.scale[axis], axes[axis]);
        round_lanes(axes[axis]);
    }
    set_group_cells(axes, out.cells);
    if (group.count == 1) out.cells[0] = {};
    set_group_boxes(group, in, axes, group.count == 1 ? 0 : in.count, out.boxes);
    set_densities(grid.columns, in, heights.height, out.densities);
}

} // namespace
