// Trees as they usually lie, in one pass: what tree.cpp finds nothing wrong with.
#include "check/tree_roots.h"

namespace acdf {

namespace {

using u8 = std::uint8_t;
using u16 = std::uint16_t;
using u32 = std::uint32_t;
using u64 = std::uint64_t;

/// What is inherited on an axis: positions.
struct Inherited {
    u32 low, high;
};

// Whether knots lie inside what is inherited, each behind the one before.
template <class T>
bool knots_rise(const u8* array, u32 count, Inherited range) {
    const T* const knots = reinterpret_cast<const T*>(array);
    u32 before = range.low;
    for (u32 i = 0; i < count; ++i) {
        if (knots[i] <= before) return false;
        before = knots[i];
    }
    return before < range.high;
}

bool knots_are_right(const AcdfCurve& curve, Inherited range) {
    const u32 count = curve.segments - 1;
    if (count == 0) return true;
    switch (ACDF_CURVE_POSITION_CODE(curve.header)) {
    case 0:
        return knots_rise<u8>(curve.positions, count, {0, range.high - range.low}); // counted from its low end
    case 1:
        return knots_rise<u16>(curve.positions, count, range);
    default:
        return knots_rise<u32>(curve.positions, count, range);
    }
}

template <class T>
bool never_falls(const u8* array, u32 count) {
    const T* const values = reinterpret_cast<const T*>(array);
    T before = 0;
    for (u32 i = 0; i < count; ++i) {
        if (values[i] < before) return false;
        before = values[i];
    }
    return true;
}

bool values_are_right(const AcdfCurve& curve) {
    const u32 count = curve.segments - 1;
    switch (ACDF_CURVE_CUMULATIVE_CODE(curve.header)) {
    case 0:
        return never_falls<u8>(curve.cumulative, count);
    case 1:
        return never_falls<u16>(curve.cumulative, count);
    default:
        return never_falls<u32>(curve.cumulative, count);
    }
}

bool is_zero(const u8* begin, const u8* end) {
    for (; begin < end; ++begin)
        if (*begin != 0) return false;
    return true;
}

// Between arrays, which begin where their elements are aligned; `next` is where the next curve begins.
bool padding_is_zero(const AcdfCurve& curve, const u8* begin, const u8* next) {
    const u32 header = curve.header, interior = curve.segments - 1;
    if (ACDF_CURVE_CUMULATIVE_CODE(header) + ACDF_CURVE_POSITION_CODE(header) + ACDF_CURVE_LINK_CODE(header) == 0)
        return true; // two arrays of as many bytes, of which none are aligned
    const u8* end = begin + (header >> ACDF_CURVE_SEGMENTS_SHIFT ? 2 : 6);
    if (!is_zero(end, curve.cumulative)) return false;
    end = curve.cumulative + (u64{interior} << ACDF_CURVE_CUMULATIVE_CODE(header));
    if (!is_zero(end, curve.positions)) return false;
    end = curve.positions + (u64{interior} << ACDF_CURVE_POSITION_CODE(header));
    if (curve.links) {
        if (!is_zero(end, curve.links)) return false;
        end = curve.links + (u64{curve.segments} << (ACDF_CURVE_LINK_CODE(header) - 1));
    }
    return is_zero(end, curve.tilts ? curve.tilts : next);
}

bool tilts_are_right(const AcdfCurve& curve) {
    const auto* const tilts = reinterpret_cast<const std::int16_t*>(curve.tilts);
    for (u32 i = 0; tilts && i < curve.segments; ++i)
        if (tilts[i] == -32768) return false;
    return true;
}

// What check_curve reports of short curves that end, which most are.
struct Short {
    u32 axis, knot; ///< the last one, counted from the range's low end
    u32 next;       ///< where the next curve begins
    u32 segments;
    bool right;
};

#ifdef ACDF_SSE2
// Bits of bytes of `count` values: those that are equal in both.
bool are_equal(__m128i a, __m128i b, u32 bytes) {
    const u32 equal = static_cast<u32>(_mm_movemask_epi8(_mm_cmpeq_epi8(a, b)));
    return (~equal & ((1u << bytes) - 1)) == 0;
}

// Up to eight knots of a byte, and as many cumulative values of `size` bytes, 1 or 2, compared with those before
// them.
bool rise(const u8* cumulative, const u8* positions, u32 count, u32 size) {
    const __m128i zero = _mm_setzero_si128();
    const __m128i knots = _mm_loadl_epi64(reinterpret_cast<const __m128i*>(positions)),
                  before = _mm_slli_si128(knots, 1);
    const __m128i values = _mm_loadu_si128(reinterpret_cast<const __m128i*>(cumulative));
    const __m128i falls = size == 1 ? _mm_subs_epu8(_mm_slli_si128(values, 1), values)
                                    : _mm_subs_epu16(_mm_slli_si128(values, 2), values);
    const __m128i rises = _mm_cmpeq_epi8(_mm_subs_epu8(knots, before), zero); // where they do not
    return are_equal(rises, zero, count) && are_equal(falls, zero, count * size);
}
#else
bool rise(const u8* cumulative, const u8* positions, u32 count, u32 size) {
    return knots_rise<u8>(positions, count, {0, 256}) &&
           (size == 1 ? never_falls<u8>(cumulative, count) : never_falls<u16>(cumulative, count));
}
#endif

// Whether a curve is one of these: without children and tilts, of two to nine segments with positions of a byte and
// cumulative values of one or two, and far enough from the end to load sixteen bytes of each.
bool check_short(const CheckedTree& tree, u32 at, Short& out) {
    constexpr u32 fewest = 2, most = 9, room = 1 + (2 * (most - 1) + 16) / 2;
    constexpr u32 others = 0x3F0; // bits of a header that are 0
    static_assert(ACDF_CURVE_CUMULATIVE_CODE(others) == 2 && ACDF_CURVE_POSITION_CODE(others) == 3 &&
                  ACDF_CURVE_LINK_CODE(others) == 3 && (others & ACDF_CURVE_TILTED) != 0);
    const u32 header = tree.unit(at), segments = header >> ACDF_CURVE_SEGMENTS_SHIFT;
    if ((header & others) != 0 || segments - fewest > most - fewest || tree.units - at < room) return false;
    const u32 count = segments - 1, size = acdf_element_size(ACDF_CURVE_CUMULATIVE_CODE(header));
    const u8 *const cumulative = tree.data() + u64{at} * 2 + 2, *const positions = cumulative + count * size,
                    *const end = positions + count;
    const u32 odd = count & (size - 1); // with a byte of padding
    out = {header & ACDF_CURVE_AXIS_MASK, end[-1], at + 1 + (count * (size + 1) + odd) / 2, segments,
           rise(cumulative, positions, count, size) && (*end & (0u - odd)) == 0};
    return true;
}

class Preorder {
public:
    explicit Preorder(const CheckedTree& tree) : tree_(tree), roots_(tree), work_(u64{2} * tree.units) {
        for (u32 axis = 0; axis < ACDF_MAX_AXES; ++axis)
            if (tree.sampled(axis)) resolution_[axis] = tree.parts.axes[axis].resolution;
    }

    bool is_right() {
        next_root();
        while (next_ < tree_.units)
            if (!curve()) return false;
        return open_count_ == 0 && !has_root_ && curves_ <= tree_.units / 2 + 1;
    }

private:
    /// A curve some of whose children are still to come.
    struct Open {
        AcdfCurve curve;
        u32 at, segment; ///< where it is; where the next child is looked for first
        u32 children;
        u32 tilted;      ///< axes, above it
        Inherited range; ///< of its axis
    };

    void next_root() { has_root_ = roots_.next(root_); }

    // A tree of its own begins.
    bool begin() {
        if (!has_root_ || root_.unit != next_) return false;
        for (u32 axis = 0; axis < ACDF_MAX_AXES; ++axis) {
            if (resolution_[axis] >= 0x80000000u) return false;
            range_[axis] = {0, resolution_[axis]};
        }
        tilted_ = 0;
        return true;
    }

    // What a root asks of the curves below it is what is known of them, anyway.
    bool is_whole() const {
        for (u32 axis = 0; axis < ACDF_MAX_AXES; ++axis)
            if (range_[axis].low != 0 || range_[axis].high != resolution_[axis]) return false;
        return true;
    }

    // Checks the curve that is the next one, and enters it.
    bool curve() {
        const u32 at = next_;
        if (!(open_count_ > 0 ? enter() : begin())) return false;
        for (; has_root_ && root_.unit <= at; next_root())
            if (root_.unit != at || !is_whole()) return false;
        ++curves_;
        Short end;
        if (check_short(tree_, at, end)) return end.right && pass(end);
        if (!header_is_legal(tree_.unit(at)) || segments_of(tree_, at) == 0) return false;
        AcdfCurve curve;
        const std::size_t next = acdf_curve_decode(tree_.data(), at, &curve);
        const u32 axis = acdf_curve_axis(&curve);
        if (next > tree_.units || tilted_ >> axis & 1 || resolution_[axis] == 0 ||
            !knots_are_right(curve, range_[axis]) || !values_are_right(curve) ||
            !padding_is_zero(curve, tree_.data() + u64{at} * 2, tree_.data() + u64{next} * 2) ||
            !tilts_are_right(curve))
            return false;
        next_ = static_cast<u32>(next);
        if (curve.links && !open(curve, at)) return false;
        leave();
        return true;
    }

    bool pass(const Short& curve) {
        const Inherited range = range_[curve.axis];
        next_ = curve.next;
        const bool right =
            !(tilted_ >> curve.axis & 1) && resolution_[curve.axis] != 0 && curve.knot < range.high - range.low;
        leave();
        return right;
    }

    // Curves all of whose children were seen.
    void leave() {
        while (open_count_ > 0 && open_[open_count_ - 1].children == 0) {
            const Open& last = open_[--open_count_];
            range_[acdf_curve_axis(&last.curve)] = last.range;
            tilted_ = last.tilted;
        }
    }

    // Segments without probability have no children.
    bool open(const AcdfCurve& curve, u32 at) {
        u32 children = 0, low = 0;
        for (u32 i = 0; i < curve.segments; ++i) {
            const u32 high = acdf_curve_cumulative(&curve, i + 1);
            const bool linked = acdf_curve_link(&curve, i) != 0;
            if (linked && low == high) return false;
            children += linked;
            low = high;
        }
        open_[open_count_++] = {curve, at, 0, children, tilted_, range_[acdf_curve_axis(&curve)]};
        return true;
    }

    // Finds the segment of the innermost curve that leads to the next one. All links are found so, if not more
    // than one leads there, as there are as many as there are children.
    bool enter() {
        if (open_count_ == ACDF_MAX_DEPTH) return false;
        Open& parent = open_[open_count_ - 1];
        const u32 distance = next_ - parent.at;
        while (acdf_curve_link(&parent.curve, parent.segment) != distance) {
            if (work_-- == 0) return false;
            if (++parent.segment == parent.curve.segments) parent.segment = 0;
        }
        const u32 axis = acdf_curve_axis(&parent.curve);
        AcdfRange range = {parent.range.low, parent.range.high, 0.0};
        acdf_curve_narrow(&parent.curve, parent.segment, &range);
        range_[axis] = {range.low, range.high};
        tilted_ = range.tilt != 0.0 ? parent.tilted | 1u << axis : parent.tilted;
        --parent.children;
        if (++parent.segment == parent.curve.segments) parent.segment = 0;
        return true;
    }

    const CheckedTree& tree_;
    TreeRoots roots_;
    u64 work_;                           ///< links that may be looked at in vain
    u32 resolution_[ACDF_MAX_AXES] = {}; ///< 0: not sampled
    Inherited range_[ACDF_MAX_AXES] = {};
    u32 tilted_ = 0, next_ = 0, curves_ = 0, open_count_ = 0;
    bool has_root_ = false;
    TreeRoot root_ = {}; ///< the next one
    Open open_[ACDF_MAX_DEPTH];
};

} // namespace

bool is_right_in_preorder(const CheckedTree& tree) noexcept { return Preorder(tree).is_right(); }

} // namespace acdf
