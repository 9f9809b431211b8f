#include "tables/tree_survey.h"

namespace acdf {

using u32 = std::uint32_t;

TreeSurvey::TreeSurvey(const AcdfEnvironment& environment, u32 tree_units) noexcept : tree_(environment.tree) {
    u32 cells = 0;
    if (begin(tree_units) && walk(environment.root, cells)) end(cells);
}

bool TreeSurvey::begin(u32 tree_units) noexcept {
    most_steps_ = 2 * std::size_t{tree_units} + 64;
    return below_.add(tree_units / 2 + 1, 0) != nullptr;
}

void TreeSurvey::end(u32 cells) noexcept {
    cells_ = cells;
    done_ = true;
}

// A path passes at most 64 curves.
bool TreeSurvey::walk(u32 at, u32& cells) noexcept {
    const AcdfCurve curve = acdf_curve_at(tree_, at);
    steps_ += curve.segments;
    cells = curve.segments;
    if (curve.tilts || steps_ > most_steps_) return false;
    for (u32 i = 0; curve.links && i < curve.segments; ++i) {
        const u32 link = acdf_curve_link(&curve, i);
        if (link == 0) continue;
        const u32 header = reinterpret_cast<const std::uint16_t*>(tree_)[at + link];
        u32 below = header >> ACDF_CURVE_SEGMENTS_SHIFT;
        if (ends(header)) steps_ += below; // as most
        else if (!walk(at + link, below)) return false;
        cells += below - 1;
    }
    if (!ends(curve.header)) add(at, cells);
    return steps_ <= most_steps_;
}

} // namespace acdf
