#include "tables/entry_widths.h"

#include "tables/curve_segments.h"

#include <cstring>

namespace acdf {

namespace {

using u32 = std::uint32_t;

constexpr u32 kFewCells = 64; // below a curve: how they lie there is not looked at

// Of a positive number.
double logarithm(double x) {
    std::uint64_t bits;
    std::memcpy(&bits, &x, sizeof bits);
    return static_cast<double>(bits) * 0x1p-52 - 1023.0;
}

} // namespace

EntryWidthsFinder::EntryWidthsFinder(const AcdfTable& table, const TreeSurvey& survey) noexcept
    : table_(table), survey_(survey), first_axis_(table.indexed_count), axes_(acdf_table_sampled_count(&table)),
      segments_left_(2 * std::size_t{table.tree_units} + 64) {}

bool EntryWidthsFinder::find(u32 root, EntryWidths& out) noexcept {
    Reached all[ACDF_MAX_AXES];
    for (u32 axis = 0; axis < axes_; ++axis) {
        all[axis].last = table_.axes[first_axis_ + axis].resolution;
        all[axis].place = logarithm(all[axis].last);
    }
    if (!add(root, all, out)) return false;
    for (u32 axis = 0; axis < axes_; ++axis) out.place[axis] -= static_cast<double>(out.cells) * all[axis].place;
    return true;
}

bool EntryWidthsFinder::pass(std::size_t segments) noexcept {
    const bool enough = segments <= segments_left_;
    segments_left_ -= enough ? segments : 0;
    return enough;
}

u32 EntryWidthsFinder::cells_below(u32 at, u32 header) const noexcept {
    return survey_.done() ? survey_.cells(at, header) : TreeSurvey::kMany;
}

// Those below a curve. A path passes at most 64 curves.
bool EntryWidthsFinder::add(u32 at, Reached* reached, EntryWidths& out) noexcept {
    const AcdfCurve curve = acdf_curve_at(table_.tree, at);
    const u32 axis = acdf_curve_axis(&curve) - first_axis_;
    if (curve.tilts || !pass(curve.segments)) return false;
    Reached& side = reached[axis];
    const Reached above = side;
    CurveSegments segments(curve, above.first, above.last);
    const double of_all = above.number - logarithm(segments.maximum());
    double positions = 0.0, numbers = 0.0, divided = 0.0;
    std::size_t cells = 0;
    while (segments.number() < curve.segments) {
        const u32 link = segments.link();
        const CurveSegment segment = segments.next();
        const u32 part = segment.to - segment.from;
        side.first = segment.first;
        side.last = segment.last;
        side.place = logarithm(side.last - side.first);
        side.number = part > 0 ? of_all + logarithm(part) : 0.0; // no number leads there
        u32 below = 1;
        if (link > 0 && part > 0) {
            const u32 header = reinterpret_cast<const std::uint16_t*>(table_.tree)[at + link];
            below = cells_below(at + link, header);
            if (below > kFewCells) {
                if (!add(at + link, reached, out)) return false;
                continue;
            }
            if (!pass(below)) return false;
            const double by = below * logarithm(below);
            if (TreeSurvey::ends(header)) out.divide((header & ACDF_CURVE_AXIS_MASK) - first_axis_, by);
            else divided += by / axes_;
        }
        positions += below * side.place;
        numbers += below * side.number;
        cells += below;
    }
    side = above;
    out.place[axis] += positions;
    out.number[axis] += numbers;
    for (u32 other = 0; other < axes_; ++other) { // all of them are alike there
        out.divide(other, divided);
        if (other == axis) continue;
        out.place[other] += static_cast<double>(cells) * reached[other].place;
        out.number[other] += static_cast<double>(cells) * reached[other].number;
    }
    out.cells += cells;
    return true;
}

} // namespace acdf
