#include "measure/cells.h"

namespace acdf::measure {
namespace {

void descend(const std::uint8_t* tree, std::uint32_t at, const Cell& cell,
             const std::function<void(const Cell&)>& visit) {
    const AcdfCurve curve = acdf_curve_at(tree, at);
    const std::uint32_t axis = acdf_curve_axis(&curve);
    const double maximum = acdf_curve_maximum(&curve);
    for (std::uint32_t i = 0; i < curve.segments; ++i) {
        const std::uint32_t width = acdf_curve_cumulative(&curve, i + 1) - acdf_curve_cumulative(&curve, i);
        Cell part = cell;
        part.probability *= width / maximum;
        acdf_curve_narrow(&curve, i, &part.range[axis]);
        const std::uint32_t link = acdf_curve_link(&curve, i);
        if (link == 0 || width == 0) visit(part);
        else descend(tree, at + link, part, visit);
    }
}

} // namespace

void for_each_cell(const File& file, std::uint32_t root, const std::function<void(const Cell&)>& visit) {
    Cell whole;
    whole.range[0] = {0, file.axis(0).resolution, 0.0};
    whole.range[1] = {0, file.axis(1).resolution, 0.0};
    whole.probability = 1.0;
    descend(file.tree(), root, whole, visit);
}

} // namespace acdf::measure
