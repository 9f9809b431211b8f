#include "tables/tree_survey.h"

namespace acdf {

using u32 = std::uint32_t;

TreeSurvey::TreeSurvey(const AcdfEnvironment& environment, u32 tree_units) noexcept
    : tree_(environment.tree), most_steps_(2 * std::size_t{tree_units} + 64) {
    u32 cells = 0;
    curves_.reserve(tree_units / 6); // most have as many; where not, it grows
    done_ = walk(environment.root, cells) && !curves_.failed();
}

// A path passes at most 64 curves.
bool TreeSurvey::walk(u32 at, u32& cells) noexcept {
    const AcdfCurve curve = acdf_curve_at(tree_, at);
    const std::size_t self = curves_.size();
    steps_ += curve.segments;
    if (curve.tilts || steps_ > most_steps_ || !curves_.add(1, {})) return false;
    cells = curve.segments;
    for (u32 i = 0; curve.links && i < curve.segments; ++i) {
        const u32 link = acdf_curve_link(&curve, i);
        if (link == 0) continue;
        const u32 header = reinterpret_cast<const std::uint16_t*>(tree_)[at + link];
        u32 below = header >> ACDF_CURVE_SEGMENTS_SHIFT;
        if (below > 0 && ACDF_CURVE_LINK_CODE(header) == 0 &&
            !(header & ACDF_CURVE_TILTED)) { // as most: cells alone
            steps_ += below;
            curves_.add({below, 1});
        } else if (!walk(at + link, below)) {
            return false;
        }
        cells += below - 1;
    }
    curves_[self] = {cells, static_cast<u32>(curves_.size() - self)};
    return steps_ <= most_steps_ && !curves_.failed();
}

} // namespace acdf
