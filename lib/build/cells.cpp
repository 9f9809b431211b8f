#include "build/cells.h"

#include <algorithm>

namespace acdf::build {
namespace {

template <class AnyCell, class Visit>
void descend(const std::uint8_t* tree, std::uint32_t at, const AnyCell& cell, const Visit& visit) {
    const AcdfCurve curve = acdf_curve_at(tree, at);
    const std::uint32_t axis = acdf_curve_axis(&curve);
    const double maximum = acdf_curve_maximum(&curve);
    for (std::uint32_t i = 0; i < curve.segments; ++i) {
        const std::uint32_t width = acdf_curve_cumulative(&curve, i + 1) - acdf_curve_cumulative(&curve, i);
        AnyCell part = cell;
        part.probability *= width / maximum;
        acdf_curve_narrow(&curve, i, &part.range[axis]);
        const std::uint32_t link = acdf_curve_link(&curve, i);
        if (link == 0 || width == 0) visit(part);
        else descend(tree, at + link, part, visit);
    }
}

template <std::size_t Axes>
CellOf<Axes> whole(const File& file) {
    CellOf<Axes> cell = {};
    for (std::uint32_t axis = 0; axis < std::min<std::size_t>(Axes, file.description().axis_count); ++axis)
        cell.range[axis] = {0, file.axis(axis).resolution, 0.0};
    cell.probability = 1.0;
    return cell;
}

} // namespace

void for_each_cell(const File& file, std::uint32_t root, const std::function<void(const Cell&)>& visit) {
    descend(file.tree(), root, whole<2>(file), visit);
}

void for_each_cell_in(const File& file, std::uint32_t root, const AcdfRange* range,
                      const std::function<void(const Cell&)>& visit) {
    Cell cell = {{range[0], range[1]}, 1.0};
    descend(file.tree(), root, cell, visit);
}

void for_each_table_cell(const File& file, std::uint32_t root, const std::function<void(const TableCell&)>& visit) {
    descend(file.tree(), root, whole<ACDF_MAX_AXES>(file), visit);
}

} // namespace acdf::build
