// Gathers the cells of a tree into lanes, sixteen at a time, and what all tables reckon of them, in loops that
// compilers make vectors of: no lane branches. One source a set of instructions, compiled for it; nothing here may
// be inline with external linkage, lest the linker picks code that the processor does not have.
#pragma once

#include "tables/sides.h"

#include <acdf/sample.h>
#include <acdf/squares.h>
#include <acdf/tree.h>

#include <cstddef>
#include <cstdint>
#include <cstring>

namespace {

/// Some blocks are gathered before they are reckoned: what was just stored in parts waits to be loaded as a whole.
constexpr int kLaneBlocks = 4;
constexpr int kCellLanes = ACDF_BLOCK_CELLS;
constexpr int kLanesTogether = 8; // that are written together: some past the last cell

/// Cells as their curves tell them, one a lane. In lanes that none is in others are, or none yet.
struct CellLanes {
    static constexpr int kRoom = kCellLanes + kLanesTogether;

    /// Cumulative values of the segment, and the maximum. Equal ones: a dark cell.
    alignas(64) double from[kRoom] = {}, to[kRoom] = {}, all[kRoom];
    /// Random numbers of what the curve divides, along its axis and across.
    double low[kRoom] = {}, high[kRoom] = {}, across_low[kRoom] = {}, across_high[kRoom] = {};
    double axis[kRoom] = {}; ///< of the curve
    double probability[kRoom] = {};
    std::uint32_t first[2][kRoom] = {}, last[2][kRoom] = {}; ///< positions
    std::uint32_t group = 0;
    int count = 0;

    CellLanes() {
        for (double& most : all) most = 1.0;
    }
};

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
#ifdef ACDF_SSE2
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

static inline void move_lanes(const CellLanes& full, CellLanes& next) {
    const auto move = [](const auto* from, auto* to) {
        std::memcpy(to, from + kCellLanes, sizeof *to * kLanesTogether);
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

// ---- what is reckoned of lanes ----------------------------------------------------------------------------------

// How many positions a lane takes, of less than 2^31.
static inline double steps_of(const CellLanes& in, int axis, int i) {
    return static_cast<std::int32_t>(in.last[axis][i] - in.first[axis][i]);
}

// The numbers of each axis; what the curve does not divide keeps its own.
template <class AxisLanes>
static inline void narrow_lanes(const CellLanes& in, AxisLanes axes[2]) {
    for (int i = 0; i < kCellLanes; ++i) {
        const double width = in.high[i] - in.low[i];
        const double from = in.low[i] + width * (in.from[i] / in.all[i]);
        const double part = in.low[i] + width * (in.to[i] / in.all[i]),
                     to = in.to[i] != in.all[i] ? part : in.high[i];
        const bool first = in.axis[i] == 0.0;
        axes[0].low[i] = first ? from : in.across_low[i];
        axes[1].low[i] = first ? in.across_low[i] : from;
        axes[0].high[i] = first ? to : in.across_high[i];
        axes[1].high[i] = first ? in.across_high[i] : to;
    }
}

// As acdf_area_pdf.
static inline void set_densities(double columns, const CellLanes& in, const double* heights, float* out) {
    for (int i = 0; i < kCellLanes; ++i) {
        const double area = 2.0 * ACDF_PI * steps_of(in, 0, i) * heights[i];
        const double product = in.probability[i] * ((in.to[i] - in.from[i]) / in.all[i]);
        const double positive = product > 0x1p-1000 ? product : 0x1p-1000; // acdf_positive
        const double pdf = positive * columns / area;
        const double most = 3.402823466e38, least = 1.17549435e-38;
        const double told = pdf >= most ? most : pdf > least ? pdf : least;
        out[i] = static_cast<float>(in.from[i] < in.to[i] ? told : 0.0);
    }
}

#ifdef ACDF_SSE2
static inline __m128i four_words(const void* at) { return _mm_loadu_si128(static_cast<const __m128i*>(at)); }
#endif

// ---- cells ------------------------------------------------------------------------------------------------------

/// Gives sink.put() each block of lanes when others have been gathered behind it.
template <class Sink>
class LaneGatherer {
public:
    LaneGatherer(const AcdfEnvironment& environment, Sink& sink)
        : tree_(environment.tree), end_(tree_ + 2 * std::size_t{environment.tree_units}), sink_(sink) {}

    /// Cells of segments [first, last) of the curve at `at`, which divides `above`, and of the curves below them,
    /// in their order; what is left of the last block is not filled by others. `group`: what its lanes are told to
    /// be of.
    void gather(std::uint32_t group, std::uint32_t at, const AcdfCurve& curve, const acdf::Cell& above,
                std::uint32_t first, std::uint32_t last) {
        lanes().group = group;
        gather(at, curve, above, first, last);
        if (lanes().count > 0) next_block();
    }

    void put_blocks() {
        for (const CellLanes* block = blocks_; block < lanes_; ++block) sink_.put(*block);
        lanes_ = blocks_;
    }

private:
    CellLanes& lanes() { return *lanes_; }

    // A path passes at most 64 curves.
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
        CellLanes& to = lanes();
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
        CellLanes& lane = lanes();
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
            CellLanes& to = lanes();
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
        CellLanes& full = lanes();
        full.count += count;
        if (full.count < kCellLanes) return;
        const int over = full.count - kCellLanes;
        full.count = kCellLanes;
        next_block();
        lanes().group = full.group;
        lanes().count = over;
        if (over > 0) move_lanes(full, lanes());
    }

    void next_block() {
        if (++lanes_ == blocks_ + kLaneBlocks) put_blocks();
        lanes().count = 0;
    }

    const std::uint8_t *const tree_, *const end_;
    Sink& sink_;
    CellLanes blocks_[kLaneBlocks], *lanes_ = blocks_; // those that are gathered
};

} // namespace
