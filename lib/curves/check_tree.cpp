// The distribution itself: BINS and TREE. Linear in their bytes: the curves are visited in file order, which
// comes after every path that leads to them because links only go forward.
#include "curves/check_tree.h"
#include "check/kinds.h"

#include <acdf/curves/tree.h>

#include <cmath>
#include <cstdlib>

namespace acdf {

namespace {

constexpr u32 unreached = 0xFFFFFFFF;

// What is known of a curve, used twice with different meanings. Since there is at most one curve for every four
// bytes (rule 6018), these 8 bytes a curve are at most twice the tree, and `Starts` takes 3/32 of it.
struct Mark {
    u32 a, b;
};

u32 bits_set(u64 x) { // where a processor may lack the instruction, compilers call a function
    x -= x >> 1 & 0x5555555555555555;
    x = (x & 0x3333333333333333) + (x >> 2 & 0x3333333333333333);
    return static_cast<u32>(((x + (x >> 4)) & 0x0F0F0F0F0F0F0F0F) * 0x0101010101010101 >> 56);
}

// Where curves start, as bits, and how many start before each run of 64 units: a curve's index in constant time.
struct Starts {
    u64* bits;
    u32* before;

    bool at(u32 unit) const { return bits[unit / 64] >> (unit % 64) & 1; }
    u32 index(u32 unit) const {
        const u64 lower = bits[unit / 64] & ((u64{1} << (unit % 64)) - 1);
        return before[unit / 64] + bits_set(lower);
    }
};

struct Tree {
    const Payload& payload;
    const Payload& bins;
    const Parts& parts;
    u32 kind, units;
    Starts starts = {};
    Mark* marks = nullptr;

    const u8* data() const { return payload.data; }
    bool sampled(u32 axis) const {
        return axis < parts.description->axis_count && parts.axes[axis].role == ACDF_AXIS_SAMPLED;
    }
    u32 unit(u32 at) const { return reinterpret_cast<const u16*>(payload.data)[at]; }
    u64 at(u32 unit) const { return payload.at(u64{unit} * 2); }
    u64 at(const u8* byte) const { return payload.at(static_cast<u64>(byte - payload.data)); }
    bool starts_at(u64 unit) const { return unit < units && starts.at(static_cast<u32>(unit)); }
    Mark& mark(u32 unit) const { return marks[starts.index(unit)]; }
};

// Calls `visit(unit, bin)` for each root. Unit 0 is one too in local environments, whose bins need not be stored;
// nor need those of BRDFs.
template <class Visit>
void for_each_root(const Tree& tree, const Visit& visit) {
    const bool local = tree.kind == ACDF_KIND_LOCAL, stored = !local && tree.kind != ACDF_KIND_BRDF;
    if (local) visit(0, 0);
    for (u32 bin = 0; bin < tree.parts.description->bin_count; ++bin)
        if (const u32 root = tree.parts.bins[bin].root; stored || root != ACDF_NO_ROOT) visit(root, bin);
}

// The number of segments of a curve, 0 where it is missing, too large or written in the wrong form.
u32 segments_of(const Tree& tree, u32 unit) {
    const u32 few = tree.unit(unit) >> ACDF_CURVE_SEGMENTS_SHIFT;
    if (few != 0) return few;
    if (tree.units - unit < 3) return 0;
    const u32 many = tree.unit(unit + 1) | tree.unit(unit + 2) << 16;
    return many > ACDF_CURVE_SHORT_SEGMENTS && many <= ACDF_MAX_SEGMENTS ? many : 0;
}

// Where the next curve is. Out of line: three passes decode all curves.
ACDF_OUTLINE std::size_t decode(const Tree& tree, u32 unit, AcdfCurve& curve) {
    return acdf_curve_decode(tree.data(), unit, &curve);
}

/// Calls `visit(unit, curve)` for each curve in file order.
template <class Visit>
void for_each_curve(const Tree& tree, const Report& report, Visit visit) {
    for (u32 unit = 0; unit < tree.units && !report.stopped();) {
        AcdfCurve curve;
        const std::size_t next = decode(tree, unit, curve);
        visit(unit, curve);
        unit = static_cast<u32>(next);
    }
}

// ---- first pass: where curves start ---------------------------------------------------------------------

// Marks the starts; a header is decoded only once its codes and its count are known to be legal, and nothing behind
// the count is read. False where the start of the next curve cannot be found; else `curves` are counted.
bool find_curves(const Tree& tree, u32& curves, Report& report) {
    const Payload& payload = tree.payload;
    const u32 units = tree.units;
    curves = 0;
    for (u32 unit = 0; unit < units;) {
        const u64 at = payload.at(u64{unit} * 2);
        if (++curves > units / 2 + 1) {
            report.add(6018, at, "the curve at unit %u is number %u: too many for a TREE of %llu bytes", unit,
                       curves, static_cast<ull>(payload.size));
            return false;
        }
        const u32 header = tree.unit(unit);
        if (ACDF_CURVE_CUMULATIVE_CODE(header) > 2 || ACDF_CURVE_POSITION_CODE(header) > 2) {
            report.add(6004, at, "the header of the curve at unit %u is %04x, with unknown sizes", unit, header);
            return false;
        }
        if (segments_of(tree, unit) == 0) {
            report.add(6005, at, "the curve at unit %u has no legal number of segments", unit);
            return false;
        }
        AcdfCurve curve;
        const std::size_t next = decode(tree, unit, curve);
        if (next > units) {
            report.add(6002, at, "the curve at unit %u ends at unit %llu of %u", unit, static_cast<ull>(next),
                       units);
            return false;
        }
        tree.starts.bits[unit / 64] |= u64{1} << (unit % 64);
        unit = static_cast<u32>(next);
    }
    return true;
}

void count_before(u32 units, const Starts& starts) {
    u32 count = 0;
    for (u32 i = 0; i <= units / 64; ++i) {
        starts.before[i] = count;
        count += bits_set(starts.bits[i]);
    }
}

// ---- second pass: each curve by itself, and its links ---------------------------------------------------
// Mark::b holds the depth (0: unreached) in bits 0-15, and in bits 16-31 the axes that are tilted above.

// Padding lies between an array's end and the next one's start.
void check_zero(const Tree& tree, u32 unit, const u8* begin, const u8* end, Report& report) {
    for (const u8* p = begin; p < end; ++p)
        if (*p != 0) report.add(6011, tree.at(p), "a byte of padding of the curve at unit %u is %02x", unit, *p);
}

void check_padding(const Tree& tree, u32 unit, const AcdfCurve& curve, Report& report) {
    const u32 interior = curve.segments - 1, header = curve.header;
    const u32 header_size = header >> ACDF_CURVE_SEGMENTS_SHIFT ? 2 : 6;
    const u8* end = tree.data() + u64{unit} * 2 + header_size;
    const auto pass = [&](const u8* array, u64 bytes) {
        check_zero(tree, unit, end, array, report);
        end = array + bytes;
    };
    pass(curve.cumulative, u64{interior} * acdf_element_size(ACDF_CURVE_CUMULATIVE_CODE(header)));
    pass(curve.positions, u64{interior} * acdf_element_size(ACDF_CURVE_POSITION_CODE(header)));
    if (curve.links) pass(curve.links, u64{curve.segments} * acdf_element_size(ACDF_CURVE_LINK_CODE(header) - 1));
    if (curve.tilts) pass(curve.tilts, u64{curve.segments} * 2);
    check_zero(tree, unit, end, tree.data() + acdf_align(static_cast<std::size_t>(end - tree.data()), 2), report);
}

void check_values(const Tree& tree, u32 unit, const AcdfCurve& curve, Report& report) {
    const u32 axis = acdf_curve_axis(&curve);
    if (!tree.sampled(axis))
        report.add(6003, tree.at(unit), "the curve at unit %u is on axis %u, which is not sampled", unit, axis);
    check_padding(tree, unit, curve, report);
    const u32 position_code = ACDF_CURVE_POSITION_CODE(curve.header);
    u32 previous = 0, before = 0;
    for (u32 i = 0; i + 1 < curve.segments; ++i) {
        const u32 cumulative = acdf_curve_cumulative(&curve, i + 1);
        const u32 position = acdf_load(curve.positions, i, position_code);
        if (i > 0 && position <= before) {
            report.add(6006, tree.at(curve.positions), "the curve at unit %u: knot %u is at %u, not above the last",
                       unit, i + 1, position);
            break;
        }
        if (cumulative < previous) {
            report.add(6008, tree.at(curve.cumulative), "the curve at unit %u: %u at knot %u, %u before", unit,
                       cumulative, i + 1, previous);
            break;
        }
        before = position;
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

// Hands depth and tilts down a link.
void reach(Mark& child, u32 depth, u32 tilted) {
    const u32 known = child.b & 0xFFFF, deeper = depth + 1;
    child.b = (child.b >> 16 | tilted) << 16 | (known > deeper ? known : deeper);
}

void check_segments(const Tree& tree, u32 unit, const AcdfCurve& curve, Report& report) {
    const u32 depth = tree.mark(unit).b & 0xFFFF;
    const u32 tilted = tree.mark(unit).b >> 16;
    const u32 axis = acdf_curve_axis(&curve);
    const u32 link_size = curve.links ? acdf_element_size(ACDF_CURVE_LINK_CODE(curve.header) - 1) : 0;
    if (tilted >> axis & 1)
        report.add(6014, tree.at(unit), "the curve at unit %u is on axis %u, which is tilted above", unit, axis);
    for (u32 i = 0; i < curve.segments; ++i) {
        const Segment s = segment_of(curve, i);
        if (s.tilt == -32768)
            report.add(6013, tree.at(curve.tilts + 2 * u64{i}), "the curve at unit %u, segment %u, has tilt -32768",
                       unit, i);
        if (s.link == 0) continue;
        const u64 at = tree.at(curve.links + u64{i} * link_size);
        const u64 target = u64{unit} + s.link;
        if (s.probability == 0)
            report.add(6015, at, "the curve at unit %u, segment %u, is of probability 0 and has a child", unit, i);
        if (!tree.starts_at(target)) {
            report.add(6009, at, "the curve at unit %u, segment %u, links to unit %llu, where no curve starts",
                       unit, i, static_cast<ull>(target));
            continue;
        }
        if (depth > 0)
            reach(tree.mark(static_cast<u32>(target)), depth, s.tilt != 0 ? tilted | 1u << axis : tilted);
    }
}

// A wrong root or link leaves curves unreached: that is reported once, there. Depth is counted up to one past the
// limit: what lies deeper is not reported again.
void check_reach(const Tree& tree, u32 unit, Report& report) {
    u32& b = tree.mark(unit).b;
    const u32 depth = b & 0xFFFF;
    if (depth == 0 && report.verdict().errors == 0)
        report.add(6012, tree.at(unit), "no root leads to the curve at unit %u", unit);
    if (depth == ACDF_MAX_DEPTH + 1)
        report.add(6016, tree.at(unit), "the curve at unit %u is the 65th of a path", unit);
    if (depth > ACDF_MAX_DEPTH + 1) b = (b & 0xFFFF0000u) | (ACDF_MAX_DEPTH + 2);
}

void check_curves(const Tree& tree, Report& report) {
    for_each_root(tree, [&](u32 root, u32) {
        if (tree.starts_at(root)) tree.mark(root).b = 1; // depth 1, nothing tilted
    });
    for_each_curve(tree, report, [&](u32 unit, const AcdfCurve& curve) {
        check_reach(tree, unit, report);
        check_values(tree, unit, curve, report);
        check_segments(tree, unit, curve, report);
    });
}

// ---- third pass, once an axis: knots inside what is inherited -------------------------------------------
// Over all paths to a curve, Mark::a is the largest low end and Mark::b the smallest high end: a knot lies inside
// every path's range if it lies between them. Positions are below 2^31 (rule 5014), so the highest bit of Mark::a
// is free: it marks that paths disagree on the low end, which positions that are counted from it must not.

constexpr u32 disagree = 0x80000000;

void narrow(Mark& child, u32 low, u32 high) {
    if (child.b == unreached) {
        child = {low, high};
        return;
    }
    const u32 known = child.a & ~disagree, other = low & ~disagree;
    const u32 flag = (child.a | low) & disagree;
    child.a = (known > other ? known : other) | (known != other ? disagree : flag);
    if (child.b > high) child.b = high;
}

// False where a knot is wrong: what lies below would only be wrong for the same reason.
bool knots_are_inside(const Tree& tree, u32 unit, const AcdfCurve& curve, const Mark& inherited, Report& report) {
    const u32 code = ACDF_CURVE_POSITION_CODE(curve.header), low = inherited.a & ~disagree;
    if (code == 0 && inherited.a & disagree) {
        report.add(6019, tree.at(unit),
                   "the curve at unit %u has knots of one byte, and its range begins at %u, or lower", unit, low);
        return false;
    }
    const u32 origin = code == 0 ? low : 0; // the sum is below 2^31 + 256
    const u32 first = origin + acdf_load(curve.positions, 0, code);
    const u32 last = origin + acdf_load(curve.positions, curve.segments - 2, code);
    if (first > low && last < inherited.b) return true;
    report.add(6007, tree.at(curve.positions), "the curve at unit %u: knots %u to %u, range %u to %u", unit, first,
               last, low, inherited.b);
    return false;
}

void check_knots(const Tree& tree, u32 unit, const AcdfCurve& curve, u32 axis, Report& report) {
    const Mark inherited = tree.mark(unit);
    if (inherited.b == unreached) return;
    const bool splits = acdf_curve_axis(&curve) == axis && curve.segments > 1;
    if (splits && !knots_are_inside(tree, unit, curve, inherited, report)) return;
    for (u32 i = 0; i < curve.segments; ++i) {
        const u32 link = acdf_curve_link(&curve, i);
        if (link == 0) continue;
        AcdfTiltedRange range = {inherited.a & ~disagree, inherited.b, 0.0};
        if (splits) acdf_curve_narrow(&curve, i, &range);
        const bool own_low = splits && i > 0; // the same on every path
        narrow(tree.mark(unit + link), own_low ? range.low : inherited.a, range.high);
    }
}

void check_ranges(const Tree& tree, u32 curves, u32 axis, Report& report) {
    const u32 resolution = tree.parts.axes[axis].resolution;
    if (resolution == 0 || resolution >= disagree) return; // rule 5014
    for (u32 i = 0; i < curves; ++i) tree.marks[i] = {0, unreached};
    for_each_root(tree, [&](u32 root, u32) { narrow(tree.mark(root), 0, resolution); });
    for_each_curve(tree, report,
                   [&](u32 unit, const AcdfCurve& curve) { check_knots(tree, unit, curve, axis, report); });
}

// ---- bins -----------------------------------------------------------------------------------------------

void check_roots(const Tree& tree, Report& report) {
    for_each_root(tree, [&](u32 root, u32 bin) {
        if (!tree.starts_at(root))
            report.add(6010, tree.bins.at(u64{bin} * sizeof(AcdfBin)),
                       "bin %u: no curve starts at its root, unit %u", bin, root);
    });
}

void check_marked_tree(const Tree& tree, u32 curves, Report& report) {
    const u64 errors = report.verdict().errors;
    check_roots(tree, report);
    if (!report.stopped()) check_curves(tree, report);
    if (report.stopped() || report.verdict().errors != errors) return;
    for (u32 axis = 0; axis < tree.parts.description->axis_count && !report.stopped(); ++axis)
        if (tree.sampled(axis)) check_ranges(tree, curves, axis, report);
}

void check_found_curves(Tree& tree, Report& report) {
    u32 curves = 0;
    if (!find_curves(tree, curves, report)) return;
    count_before(tree.units, tree.starts);
    tree.marks = static_cast<Mark*>(std::calloc(curves, sizeof(Mark)));
    if (tree.marks) check_marked_tree(tree, curves, report);
    else report.add(1003, tree.at(u32{0}), "no memory to check %u curves", curves);
    std::free(tree.marks);
}

} // namespace

void check_tree(const Payload& bins, const Payload& payload, u32 kind, Report& report, Parts& parts) noexcept {
    if (bins.data) check_bins(bins, report, parts);
    if (!payload.data || report.stopped()) return;
    const u64 units = payload.size / 2;
    if (payload.size == 0 || payload.size % 2 != 0 || units > 0xFFFFFFFE) {
        report.add(6001, payload.at(0), "TREE has %llu bytes", static_cast<ull>(payload.size));
        return;
    }
    if (!parts.bins || parts.description->bin_count == 0) return;
    const u64 runs = units / 64 + 1;
    Tree tree{payload, bins, parts, kind, static_cast<u32>(units)};
    tree.starts = {static_cast<u64*>(std::calloc(runs, sizeof(u64))),
                   static_cast<u32*>(std::calloc(runs, sizeof(u32)))};
    if (tree.starts.bits && tree.starts.before) check_found_curves(tree, report);
    else report.add(1003, payload.at(0), "no memory to check %llu units of TREE", static_cast<ull>(units));
    std::free(tree.starts.bits);
    std::free(tree.starts.before);
}

} // namespace acdf
