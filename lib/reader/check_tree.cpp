// The distribution itself: BINS and TREE. Linear in their bytes: the curves are walked in file order, which
// comes after every path that leads to them because links only go forward.
#include "checker.h"

#include <cmath>
#include <cstdlib>

namespace acdf {

namespace {

using u8 = std::uint8_t;
using u16 = std::uint16_t;
using u32 = std::uint32_t;
using u64 = std::uint64_t;
using ull = unsigned long long;

constexpr u32 unreached = 0xFFFFFFFF;

// What is known of the curve that starts at a word; 8 bytes a word, used twice with different meanings.
struct Mark {
    u32 a, b;
};

struct Tree {
    const Payload& payload;
    const Parts& parts;
    u32 words;
    Mark* marks;

    const u8* data() const { return payload.data; }
    u64 at(u32 word, u64 byte = 0) const { return payload.at(u64{word} * 4 + byte); }
    bool sampled(u32 axis) const {
        return axis < parts.description->axis_count && parts.axes[axis].role == ACDF_AXIS_SAMPLED;
    }
};

/// Byte ranges of the arrays of a curve: where each begins and ends, from the curve's start.
struct CurveExtent {
    u32 cumulative_end, positions, positions_end, links, links_end, tilts, end; // `end` is a whole word
};

CurveExtent extent_of(u32 header) {
    const u32 segments = header >> ACDF_CURVE_SEGMENTS_SHIFT;
    const u32 cumulative_size = header & ACDF_CURVE_WIDE_CUMULATIVE ? 4 : 2;
    const u32 position_size = header & ACDF_CURVE_WIDE_POSITIONS ? 4 : 2;
    const u32 links = (header & ACDF_CURVE_LINKS_MASK) >> ACDF_CURVE_LINKS_SHIFT;
    const u32 link_size = links == ACDF_LINKS_32 ? 4 : 2;
    CurveExtent e;
    e.cumulative_end = 4 + (segments - 1) * cumulative_size;
    e.positions = acdf_align(e.cumulative_end, position_size);
    e.positions_end = e.positions + (segments - 1) * position_size;
    e.links = links == ACDF_LINKS_NONE ? e.positions_end : acdf_align(e.positions_end, link_size);
    e.links_end = links == ACDF_LINKS_NONE ? e.links : e.links + segments * link_size;
    e.tilts = e.links_end; // even already
    e.end = acdf_align(e.tilts + (header & ACDF_CURVE_TILTED ? 2 * segments : 0), 4);
    return e;
}

u32 header_at(const Tree& tree, u32 word) { return *reinterpret_cast<const u32*>(tree.data() + 4 * u64{word}); }

/// Calls `visit(word, curve, extent)` for each curve in file order.
template <class Visit>
void for_each_curve(const Tree& tree, const Report& report, Visit visit) {
    for (u32 word = 0; word < tree.words && !report.stopped();) {
        const CurveExtent extent = extent_of(header_at(tree, word));
        visit(word, acdf_curve_at(tree.data(), word), extent);
        word += extent.end / 4;
    }
}

// ---- first pass: where curves start ---------------------------------------------------------------------

// False where the start of the next curve cannot be found.
bool find_curves(const Tree& tree, Report& report) {
    for (u32 word = 0; word < tree.words;) {
        const u32 header = header_at(tree, word);
        const u32 links = (header & ACDF_CURVE_LINKS_MASK) >> ACDF_CURVE_LINKS_SHIFT;
        if ((header & ACDF_CURVE_RESERVED_MASK) != 0 || links > ACDF_LINKS_32) {
            report.add(6004, tree.at(word), "the header of the curve at word %u is %08x", word, header);
            return false;
        }
        if (header >> ACDF_CURVE_SEGMENTS_SHIFT == 0) {
            report.add(6005, tree.at(word), "the curve at word %u has none", word);
            return false;
        }
        const u32 size = extent_of(header).end / 4;
        if (size > tree.words - word) {
            report.add(6002, tree.at(word), "the curve at word %u is %u words long, %u are left", word, size,
                       tree.words - word);
            return false;
        }
        tree.marks[word].a = 1;
        word += size;
    }
    return true;
}

// ---- second pass: each curve by itself, and its links ---------------------------------------------------
// Mark::a is 1 where a curve starts. Mark::b holds the depth (0: unreached) in bits 0-15, and in bits 16-31
// the axes that are tilted above.

void check_zero(const Tree& tree, u32 word, u32 begin, u32 end, Report& report) {
    const u8* base = tree.data() + 4 * u64{word};
    for (u32 i = begin; i < end; ++i)
        if (base[i] != 0) report.add(6011, tree.at(word, i), "the curve at word %u: it is %02x", word, base[i]);
}

void check_values(const Tree& tree, u32 word, const AcdfCurve& curve, const CurveExtent& e, Report& report) {
    const u32 axis = acdf_curve_axis(&curve);
    if (!tree.sampled(axis)) report.add(6003, tree.at(word), "the curve at word %u is on axis %u", word, axis);
    check_zero(tree, word, e.cumulative_end, e.positions, report);
    check_zero(tree, word, e.positions_end, e.links, report);
    check_zero(tree, word, e.tilts + (curve.tilts ? 2 * curve.segments : 0), e.end, report);
    u32 previous = 0;
    for (u32 i = 0; i + 1 < curve.segments; ++i) {
        const u32 cumulative = acdf_load(curve.cumulative, i, acdf_wide_cumulative(&curve));
        const u32 position = acdf_load(curve.positions, i, acdf_wide_positions(&curve));
        if (i > 0 && position <= acdf_load(curve.positions, i - 1, acdf_wide_positions(&curve))) {
            report.add(6006, tree.at(word, e.positions), "the curve at word %u: knot %u is at %u", word, i + 1,
                       position);
            break;
        }
        if (cumulative < previous) {
            report.add(6008, tree.at(word, 4), "the curve at word %u: %u at knot %u, %u before", word, cumulative,
                       i + 1, previous);
            break;
        }
        previous = cumulative;
    }
}

struct Segment {
    u32 probability; // of the maximum
    u32 link;
    int tilt;
};

Segment segment_of(const AcdfCurve& curve, u32 i) {
    const u32 low = acdf_curve_cumulative(&curve, i), high = acdf_curve_cumulative(&curve, i + 1);
    const int tilt = curve.tilts ? reinterpret_cast<const std::int16_t*>(curve.tilts)[i] : 0;
    return {high - low, acdf_curve_link(&curve, i), tilt};
}

void check_segments(const Tree& tree, u32 word, const AcdfCurve& curve, const CurveExtent& e, Report& report) {
    const u32 depth = tree.marks[word].b & 0xFFFF;
    const u32 tilted = tree.marks[word].b >> 16;
    const u32 axis = acdf_curve_axis(&curve);
    const u32 link_size = (e.links_end - e.links) / curve.segments;
    if (tilted >> axis & 1) report.add(6014, tree.at(word), "the curve at word %u is on axis %u", word, axis);
    for (u32 i = 0; i < curve.segments; ++i) {
        const Segment s = segment_of(curve, i);
        if (s.tilt == -32768)
            report.add(6013, tree.at(word, e.tilts + 2 * u64{i}), "the curve at word %u, segment %u", word, i);
        if (s.link == 0) continue;
        const u64 at = tree.at(word, e.links + u64{i} * link_size);
        const u64 target = u64{word} + s.link;
        if (s.probability == 0) report.add(6015, at, "the curve at word %u, segment %u, has a child", word, i);
        if (target >= tree.words || tree.marks[target].a != 1) {
            report.add(6009, at, "the curve at word %u, segment %u, links to word %llu", word, i,
                       static_cast<ull>(target));
            continue;
        }
        if (depth == 0) continue;
        Mark& child = tree.marks[target];
        const u32 child_depth = child.b & 0xFFFF, deeper = depth + 1;
        u32 child_tilted = child.b >> 16 | tilted;
        if (s.tilt != 0) child_tilted |= 1u << axis;
        child.b = child_tilted << 16 | (child_depth > deeper ? child_depth : deeper);
    }
}

// A wrong root or link leaves curves unreached: that is told once, there. Depth is counted up to one past the
// limit: what lies deeper is not told again.
void check_reach(const Tree& tree, u32 word, Report& report) {
    u32& b = tree.marks[word].b;
    const u32 depth = b & 0xFFFF;
    if (depth == 0 && report.verdict().errors == 0) report.add(6012, tree.at(word), "the curve at word %u", word);
    if (depth == ACDF_MAX_DEPTH + 1) report.add(6016, tree.at(word), "the curve at word %u is the 65th", word);
    if (depth > ACDF_MAX_DEPTH + 1) b = (b & 0xFFFF0000u) | (ACDF_MAX_DEPTH + 2);
}

void check_curves(const Tree& tree, Report& report) {
    for (u32 i = 0; i < tree.parts.description->bin_count; ++i) {
        const u32 root = tree.parts.bins[i].root;
        if (root < tree.words && tree.marks[root].a == 1) tree.marks[root].b = 1; // depth 1, nothing tilted
    }
    for_each_curve(tree, report, [&](u32 word, const AcdfCurve& curve, const CurveExtent& extent) {
        check_reach(tree, word, report);
        check_values(tree, word, curve, extent, report);
        check_segments(tree, word, curve, extent, report);
    });
}

// ---- third pass, once an axis: knots inside what is inherited -------------------------------------------
// Mark::a is the largest low end, Mark::b the smallest high end over all paths to the curve: a knot lies
// inside every path's range if it lies between these two.

void narrow(Mark& child, u32 low, u32 high) {
    if (child.a < low) child.a = low;
    if (child.b > high) child.b = high;
}

void check_knots(const Tree& tree, u32 word, const AcdfCurve& curve, const CurveExtent& e, u32 axis,
                 Report& report) {
    const Mark inherited = tree.marks[word];
    if (inherited.b == unreached) return;
    const bool splits = acdf_curve_axis(&curve) == axis && curve.segments > 1;
    const bool wide = acdf_wide_positions(&curve) != 0;
    if (splits) {
        const u32 first = acdf_load(curve.positions, 0, wide);
        const u32 last = acdf_load(curve.positions, curve.segments - 2, wide);
        if (first <= inherited.a || last >= inherited.b)
            report.add(6007, tree.at(word, e.positions), "the curve at word %u: knots %u to %u, range %u to %u",
                       word, first, last, inherited.a, inherited.b);
    }
    for (u32 i = 0; i < curve.segments; ++i) {
        const u32 link = acdf_curve_link(&curve, i);
        if (link == 0) continue;
        const u32 low = splits && i > 0 ? acdf_load(curve.positions, i - 1, wide) : inherited.a;
        const u32 high = splits && i + 1 < curve.segments ? acdf_load(curve.positions, i, wide) : inherited.b;
        narrow(tree.marks[word + link], low, high);
    }
}

void check_ranges(const Tree& tree, u32 axis, Report& report) {
    for (u32 i = 0; i < tree.words; ++i) tree.marks[i] = {0, unreached};
    for (u32 i = 0; i < tree.parts.description->bin_count; ++i)
        narrow(tree.marks[tree.parts.bins[i].root], 0, tree.parts.axes[axis].resolution);
    for_each_curve(tree, report, [&](u32 word, const AcdfCurve& curve, const CurveExtent& extent) {
        check_knots(tree, word, curve, extent, axis, report);
    });
}

// ---- bins -----------------------------------------------------------------------------------------------

bool check_bins(const Payload& payload, Report& report, Parts& parts) {
    const u32 count = parts.description->bin_count;
    if (payload.size != u64{count} * sizeof(AcdfBin)) {
        report.add(4004, payload.at(0), "BINS has %llu bytes for %u bins", static_cast<ull>(payload.size), count);
        return false;
    }
    parts.bins = reinterpret_cast<const AcdfBin*>(payload.data);
    for (u32 i = 0; i < count && !report.stopped(); ++i)
        if (const float share = parts.bins[i].share; !std::isfinite(share) || share < 0.0f)
            report.add(6017, payload.at(i * sizeof(AcdfBin) + offsetof(AcdfBin, share)), "bin %u: it is %g", i,
                       static_cast<double>(share));
    return true;
}

void check_roots(const Tree& tree, const Payload& bins, Report& report) {
    for (u32 i = 0; i < tree.parts.description->bin_count && !report.stopped(); ++i) {
        const u32 root = tree.parts.bins[i].root;
        if (root >= tree.words || tree.marks[root].a != 1)
            report.add(6010, bins.at(i * sizeof(AcdfBin)), "bin %u: word %u", i, root);
    }
}

void check_marked_tree(const Tree& tree, const Payload& bins, Report& report) {
    if (!find_curves(tree, report)) return;
    const u64 errors = report.verdict().errors;
    check_roots(tree, bins, report);
    if (!report.stopped()) check_curves(tree, report);
    if (report.stopped() || report.verdict().errors != errors) return;
    for (u32 axis = 0; axis < tree.parts.description->axis_count && !report.stopped(); ++axis)
        if (tree.sampled(axis)) check_ranges(tree, axis, report);
}

} // namespace

void check_tree(const Payload& bins, const Payload& payload, Report& report, Parts& parts) noexcept {
    const bool bins_ok = bins.data && check_bins(bins, report, parts);
    if (!payload.data || report.stopped()) return;
    const u64 words = payload.size / 4;
    if (payload.size == 0 || payload.size % 4 != 0 || words > 0xFFFFFFFF) {
        report.add(6001, payload.at(0), "it has %llu bytes", static_cast<ull>(payload.size));
        return;
    }
    if (!bins_ok || parts.description->bin_count == 0) return;
    // Two words of scratch for each word that is really there.
    Mark* marks = static_cast<Mark*>(std::calloc(words, sizeof(Mark)));
    if (!marks) {
        report.add(1003, payload.at(0), "%llu bytes to check the tree", static_cast<ull>(words * sizeof(Mark)));
        return;
    }
    parts.tree = payload.data;
    parts.tree_words = static_cast<u32>(words);
    check_marked_tree(Tree{payload, parts, parts.tree_words, marks}, bins, report);
    std::free(marks);
}

} // namespace acdf
