// Gathers the cells of groups, block by block, and writes what is reckoned of them. Internal linkage: see
// group_block_kernel.h.
#pragma once

#include "group_block_kernel.h"

#include <acdf/tree.h>

#include <cstring>

namespace {

/// Some blocks are gathered before they are reckoned: what was just stored in parts waits to be loaded as a whole.
constexpr int kGroupBlocks = 4;

// ---- eight lanes ------------------------------------------------------------------------------------------------

#if defined(__GNUC__)
typedef double EightDoubles __attribute__((vector_size(64), aligned(8), may_alias));
typedef std::uint32_t EightWords __attribute__((vector_size(32), aligned(4), may_alias));
static inline void fill_lanes(double* out, double x) { *(EightDoubles*)out = EightDoubles{x, x, x, x, x, x, x, x}; }
static inline void fill_lanes(std::uint32_t* out, std::uint32_t x) {
    *(EightWords*)out = EightWords{x, x, x, x, x, x, x, x};
}
#else
template <class T>
static inline void fill_lanes(T* out, T x) {
    for (int i = 0; i < kLanesTogether; ++i) out[i] = x;
}
#endif

// Cumulative values of a byte or two, from which lanes run, and to which those before them do.
#ifdef ACDF_SQUARES_SSE2
static inline void set_values(const std::uint8_t* stored, std::uint32_t code, double* from, double* to) {
    const __m128i zero = _mm_setzero_si128(), values = _mm_loadu_si128((const __m128i*)stored);
    const __m128i words = code == 0 ? _mm_unpacklo_epi8(values, zero) : values;
    for (int half = 0; half < 2; ++half) {
        const __m128i four = half == 0 ? _mm_unpacklo_epi16(words, zero) : _mm_unpackhi_epi16(words, zero);
        const __m128d two[2] = {_mm_cvtepi32_pd(four), _mm_cvtepi32_pd(_mm_shuffle_epi32(four, 0xEE))};
        for (int k = 0; k < 2; ++k) {
            _mm_storeu_pd(from + 4 * half + 2 * k, two[k]);
            _mm_storeu_pd(to + 4 * half + 2 * k, two[k]);
        }
    }
}
static inline void set_positions(const std::uint8_t* stored, std::uint32_t origin, std::uint32_t* first,
                                 std::uint32_t* last) {
    const __m128i zero = _mm_setzero_si128(), low = _mm_set1_epi32((int)origin);
    const __m128i words = _mm_unpacklo_epi8(_mm_loadl_epi64((const __m128i*)stored), zero);
    const __m128i four[2] = {_mm_add_epi32(_mm_unpacklo_epi16(words, zero), low),
                             _mm_add_epi32(_mm_unpackhi_epi16(words, zero), low)};
    for (int half = 0; half < 2; ++half) {
        _mm_storeu_si128((__m128i*)first + half, four[half]);
        _mm_storeu_si128((__m128i*)last + half, four[half]);
    }
}
#else
static inline void set_values(const std::uint8_t* stored, std::uint32_t code, double* from, double* to) {
    for (std::uint32_t i = 0; i < kLanesTogether; ++i) from[i] = to[i] = acdf_load(stored, i, code);
}
static inline void set_positions(const std::uint8_t* stored, std::uint32_t origin, std::uint32_t* first,
                                 std::uint32_t* last) {
    for (int i = 0; i < kLanesTogether; ++i) first[i] = last[i] = origin + stored[i];
}
#endif

// ---- cells ------------------------------------------------------------------------------------------------------

static inline void move_lanes(const GroupLanes& full, GroupLanes& next) {
    const auto move = [](const auto* from, auto* to) {
        std::memcpy(to, from + kGroupLanes, sizeof *to * kLanesTogether);
    };
    move(full.from, next.from);
    move(full.to, next.to);
    move(full.all, next.all);
    move(full.low, next.low);
    move(full.high, next.high);
    move(full.across_low, next.across_low);
    move(full.across_high, next.across_high);
    move(full.axis, next.axis);
    move(full.probability, next.probability);
    for (int axis = 0; axis < 2; ++axis) {
        move(full.first[axis], next.first[axis]);
        move(full.last[axis], next.last[axis]);
    }
}

class GroupCellsWriter {
public:
    explicit GroupCellsWriter(const acdf::GroupCells& of)
        : of_(of), tree_(of.environment.tree), end_(tree_ + 2 * std::size_t{of.environment.tree_units}),
          grid_{of.heights,
                of.sines,
                static_cast<double>(of.environment.columns),
                static_cast<double>(of.environment.rows),
                {2.0 * ACDF_PI / of.environment.columns, 2.0 * ACDF_PI / of.environment.rows},
                of.environment.parameterization == ACDF_PARAM_OCTAHEDRAL},
          boxes_(of.boxes), more_(of.more), cells_(of.cells), densities_(of.densities), left_(of.cell_count) {}

    void write() {
        for (std::size_t i = 0; i < of_.count; ++i) {
            const acdf::GroupRun& run = of_.runs[i];
            const acdf::GroupCurve& curve = of_.curves[run.curve];
            lanes().group = static_cast<std::uint32_t>(i);
            gather(curve.at, acdf_curve_at(tree_, curve.at), curve.above, run.first, run.last);
            if (lanes().count > 0) next_block();
        }
        put_blocks();
    }

private:
    GroupLanes& lanes() { return *lanes_; }

    // Cells of segments [first, last) of the curve at `at` and of the curves below them, in their order. A path
    // passes at most 64 curves.
    void gather(std::uint32_t at, const AcdfCurve& curve, const acdf::Cell& above, std::uint32_t first,
                std::uint32_t last) {
        if (is_plain(curve)) return add_plain(curve, above, first, last);
        const std::uint32_t axis = acdf_curve_axis(&curve), maximum = acdf_curve_maximum(&curve);
        const double low = above.low[axis], high = above.high[axis], width = high - low, all = maximum;
        acdf::Cell part = above;
        CurveBorder to = border(curve, first, above);
        for (std::uint32_t i = first; i < last; ++i) {
            const CurveBorder from = to;
            const std::uint32_t link = acdf_curve_link(&curve, i);
            to = border(curve, i + 1, above);
            if (link == 0) {
                add(curve, above, from, to);
                continue;
            }
            part.probability = above.probability * (static_cast<double>(to.cumulative - from.cumulative) / all);
            part.low[axis] = low + width * from.part;
            part.high[axis] = to.cumulative != maximum ? low + width * to.part : high;
            part.first[axis] = from.position;
            part.last[axis] = to.position;
            if (add_short(at + link, part)) continue;
            const AcdfCurve below = acdf_curve_at(tree_, at + link);
            gather(at + link, below, part, 0, below.segments);
        }
    }

    // What is the same for all cells of a curve that divides `above`, in as many lanes as are written together.
    void set_lanes(std::uint32_t axis, double all, const acdf::Cell& above) {
        GroupLanes& to = lanes();
        const std::uint32_t other = 1 - axis;
        const int at = to.count;
        fill_lanes(to.all + at, all);
        fill_lanes(to.low + at, above.low[axis]);
        fill_lanes(to.high + at, above.high[axis]);
        fill_lanes(to.across_low + at, above.low[other]);
        fill_lanes(to.across_high + at, above.high[other]);
        fill_lanes(to.axis + at, static_cast<double>(axis));
        fill_lanes(to.probability + at, above.probability);
        fill_lanes(to.first[other] + at, above.first[other]);
        fill_lanes(to.last[other] + at, above.last[other]);
    }

    // Between segments of a curve, or at its ends.
    struct CurveBorder {
        std::uint32_t cumulative, position;
        double part; ///< of all
    };
    static CurveBorder border(const AcdfCurve& curve, std::uint32_t i, const acdf::Cell& above) {
        const std::uint32_t axis = acdf_curve_axis(&curve), code = ACDF_CURVE_POSITION_CODE(curve.header);
        if (i == 0) return {0, above.first[axis], 0.0};
        if (i == curve.segments) return {acdf_curve_maximum(&curve), above.last[axis], 1.0};
        const std::uint32_t cumulative =
            acdf_load(curve.cumulative, i - 1, ACDF_CURVE_CUMULATIVE_CODE(curve.header));
        return {cumulative, (code == 0 ? above.first[axis] : 0) + acdf_load(curve.positions, i - 1, code),
                cumulative / static_cast<double>(acdf_curve_maximum(&curve))};
    }

    // A cell that a segment is.
    void add(const AcdfCurve& curve, const acdf::Cell& above, const CurveBorder& from, const CurveBorder& to) {
        GroupLanes& lane = lanes();
        const std::uint32_t axis = acdf_curve_axis(&curve);
        set_lanes(axis, acdf_curve_maximum(&curve), above);
        lane.from[lane.count] = from.cumulative;
        lane.to[lane.count] = to.cumulative;
        lane.first[axis][lane.count] = from.position;
        lane.last[axis][lane.count] = to.position;
        grow(1);
    }

    // Most curves: without children, with positions of a byte and cumulative values of one or two. Of those,
    // segments [first, last); some elements are loaded that lie behind their array.
    static constexpr std::uint32_t kOtherBits = 0x3E0 | 0x10; // of a header, that are 0
    static constexpr std::ptrdiff_t kLoadedBehind = 2 * kLanesTogether;

    void add_plain(const AcdfCurve& curve, const acdf::Cell& above, std::uint32_t first, std::uint32_t last) {
        const std::uint32_t axis = acdf_curve_axis(&curve), code = ACDF_CURVE_CUMULATIVE_CODE(curve.header);
        const double all = code == 0 ? 255.0 : 65535.0;
        std::uint32_t value = acdf_curve_cumulative(&curve, first), position = above.first[axis];
        if (first > 0) position += curve.positions[first - 1];
        while (first < last) {
            GroupLanes& to = lanes();
            const std::uint32_t left = last - first, count = left < kLanesTogether ? left : kLanesTogether;
            const int at = to.count, end = at + static_cast<int>(count);
            set_lanes(axis, all, above);
            to.from[at] = value;
            to.first[axis][at] = position;
            set_values(curve.cumulative + (first << code), code, to.from + at + 1, to.to + at);
            set_positions(curve.positions + first, above.first[axis], to.first[axis] + at + 1, to.last[axis] + at);
            first += count;
            if (first == curve.segments) {
                to.to[end - 1] = all;
                to.last[axis][end - 1] = above.last[axis];
            } else {
                value = acdf_load(curve.cumulative, first - 1, code);
                position = above.first[axis] + curve.positions[first - 1];
            }
            grow(static_cast<int>(count));
        }
    }

    bool is_plain(const AcdfCurve& curve) const {
        static_assert(ACDF_CURVE_CUMULATIVE_CODE(kOtherBits) == 2 && ACDF_CURVE_POSITION_CODE(kOtherBits) == 3 &&
                      ACDF_CURVE_LINK_CODE(kOtherBits) == 3 && (kOtherBits & ACDF_CURVE_TILTED) != 0);
        return (curve.header & kOtherBits) == 0 &&
               end_ - curve.positions >= static_cast<std::ptrdiff_t>(curve.segments) + kLoadedBehind;
    }

    // The cells of a curve, if it is one of those.
    bool add_short(std::uint32_t at, const acdf::Cell& above) {
        const std::uint8_t* const begin = tree_ + 2 * static_cast<std::size_t>(at);
        std::uint16_t header;
        std::memcpy(&header, begin, sizeof header);
        const std::uint32_t segments = header >> ACDF_CURVE_SEGMENTS_SHIFT;
        if (segments == 0) return false;
        const std::uint8_t* const positions = begin + 2 + ((segments - 1) << ACDF_CURVE_CUMULATIVE_CODE(header));
        const AcdfCurve curve = {header, segments, begin + 2, positions, nullptr, nullptr};
        if (!is_plain(curve)) return false;
        add_plain(curve, above, 0, segments);
        return true;
    }

    // Of cells that are in their lanes; those behind a full block become the first of the next one.
    void grow(int count) {
        GroupLanes& full = lanes();
        full.count += count;
        if (full.count < kGroupLanes) return;
        const int over = full.count - kGroupLanes;
        full.count = kGroupLanes;
        next_block();
        lanes().group = full.group;
        lanes().count = over;
        if (over > 0) move_lanes(full, lanes());
    }

    void next_block() {
        if (++lanes_ == blocks_ + kGroupBlocks) put_blocks();
        lanes().count = 0;
    }

    void put_blocks() {
        for (const GroupLanes* block = blocks_; block < lanes_; ++block) put(*block);
        lanes_ = blocks_;
    }

    void put(const GroupLanes& lanes) {
        const AcdfGroup& group = of_.groups[lanes.group];
        const auto count = static_cast<std::size_t>(lanes.count);
        std::uint32_t*& boxes = lanes.group >= begun_ ? boxes_ : more_;
        const bool room = left_ >= kGroupLanes; // what is behind the cells is written next
        reckon_group_lanes(grid_, group, lanes, heights_,
                           {room ? cells_ : last_cells_, room ? densities_ : last_densities_,
                            reinterpret_cast<std::uint8_t*>(boxes)});
        if (!room) {
            std::memcpy(cells_, last_cells_, count * sizeof *cells_);
            std::memcpy(densities_, last_densities_, count * sizeof *densities_);
        }
        boxes += ACDF_GROUP_WORDS;
        begun_ = lanes.group + 1;
        cells_ += count;
        densities_ += count;
        left_ -= count;
    }

    const acdf::GroupCells& of_;
    const std::uint8_t *const tree_, *const end_;
    const GroupGrid grid_;
    std::uint32_t *boxes_, *more_; // of the next group, of the next block of others
    AcdfGroupCell* cells_;
    float* densities_;
    std::size_t left_;                                   // cells
    std::uint32_t begun_ = 0;                            // groups
    GroupLanes blocks_[kGroupBlocks], *lanes_ = blocks_; // those that are gathered
    GroupHeights heights_;
    AcdfGroupCell last_cells_[kGroupLanes];
    float last_densities_[kGroupLanes];
};

} // namespace
