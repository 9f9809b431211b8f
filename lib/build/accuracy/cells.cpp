#include "build/accuracy/cells.h"

#include <acdf/curves/curves.h>

#include <algorithm>
#include <iterator>

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

/// A node of `Axes` axes at most, and how random numbers reach it.
template <std::size_t Axes>
struct Halved {
    AcdfSpan steps[Axes], box[Axes];
};

/// Calls `visit` with each leaf below a node.
template <std::size_t Axes, class Visit>
void descend(const AcdfHalving* nodes, std::uint32_t at, const Halved<Axes>& of, const Visit& visit) {
    if (at == ACDF_LEAF) return visit(of);
    const AcdfHalving node = nodes[at];
    const std::uint32_t axis = node.link & 7u;
    for (std::uint32_t upper = 0; upper < 2; ++upper) {
        Halved<Axes> half = of;
        half.steps[axis].end[1 - upper] = node.threshold;
        half.box[axis].end[1 - upper] = acdf_span_middle(&of.box[axis]);
        const bool is_leaf = node.link >> (3 + upper) & 1u;
        descend(nodes, is_leaf ? ACDF_LEAF : upper ? at + (node.link >> 5) : at + 1, half, visit);
    }
}

/// The same of two axes, with cells.
void descend(const AcdfHalving* nodes, std::uint32_t at, const AcdfSpan* steps, const AcdfSpan* box,
             const std::function<void(const Cell&)>& visit) {
    const Halved<2> of = {{steps[0], steps[1]}, {box[0], box[1]}};
    descend(nodes, at, of, [&](const Halved<2>& leaf) {
        Cell cell;
        for (std::uint32_t axis = 0; axis < 2; ++axis)
            cell.range[axis] = {leaf.box[axis].end[0], leaf.box[axis].end[1], 0.0};
        cell.probability = acdf_span_share(&leaf.steps[0]) * acdf_span_share(&leaf.steps[1]);
        visit(cell);
    });
}

template <std::size_t Axes>
CellOf<Axes> whole(const File& file) {
    CellOf<Axes> cell = {};
    for (std::uint32_t axis = 0; axis < std::min<std::size_t>(Axes, file.description().axis_count); ++axis)
        cell.range[axis] = acdf_whole_axis(file.axis(axis).resolution);
    cell.probability = 1.0;
    return cell;
}

} // namespace

void for_each_cell(const EnvironmentView& environment, const std::function<void(const Cell&)>& visit) {
    const AcdfEnvironment& data = environment.data();
    const Cell whole = {{acdf_whole_axis(data.columns), acdf_whole_axis(data.rows)}, 1.0};
    if (!data.halved) return descend(data.tree, data.root, whole, visit);
    const std::uint32_t resolution[2] = {data.columns, data.rows};
    AcdfSpan steps[2], box[2];
    const std::uint32_t root = acdf_halvings_root(data.halved, resolution, 2, steps, box);
    descend(acdf_halvings_nodes(data.halved), root, steps, box, visit);
}

void for_each_cell(const File& file, std::uint32_t root, const std::function<void(const Cell&)>& visit) {
    std::uint32_t units;
    descend(acdf_curves_tree(file.get(), &units), root, whole<2>(file), visit);
}

std::vector<std::array<AcdfRange, 2>> tile_boxes(const File& file) {
    std::vector<std::array<AcdfRange, 2>> out;
    const AcdfNormalRows* rows = file.local().data().rows_of_normals;
    for (std::uint32_t t = 0; rows && t <= rows->splits; ++t) {
        const AcdfTopTile& tile = ACDF_TOP_ARRAY(AcdfTopTile, rows, rows->tiles)[t];
        acdf_halved_ranges(tile.box, out.emplace_back().data());
    }
    return out;
}

void for_each_tile_cell(const File& file, std::uint32_t tile, const std::function<void(const Cell&)>& visit) {
    const AcdfLocal local = file.local().data();
    const AcdfTopTile& of = ACDF_TOP_ARRAY(AcdfTopTile, local.rows_of_normals, local.rows_of_normals->tiles)[tile];
    const double whole = acdf_span_share(&of.steps[0]) * acdf_span_share(&of.steps[1]);
    descend(acdf_halvings_nodes(local.environment.halved), of.node, of.steps, of.box, [&](Cell cell) {
        cell.probability = of.node == ACDF_LEAF ? 1.0 : cell.probability / whole;
        visit(cell);
    });
}

void for_each_table_cell(const File& file, std::uint32_t bin, const std::function<void(const TableCell&)>& visit) {
    const AcdfTable table = file.table().data();
    AcdfTablePosition place = {};
    acdf_table_whole(&table, &place);
    Halved<ACDF_MAX_AXES> whole;
    std::copy(std::begin(place.steps), std::end(place.steps), whole.steps);
    std::copy(std::begin(place.box), std::end(place.box), whole.box);
    descend(table.nodes, file.bin(bin).root, whole, [&](const Halved<ACDF_MAX_AXES>& leaf) {
        TableCell cell = {};
        std::copy(std::begin(leaf.box), std::end(leaf.box), cell.box);
        std::copy(std::begin(leaf.steps), std::end(leaf.steps), place.steps);
        cell.probability = acdf_table_probability(&table, &place);
        visit(cell);
    });
}

} // namespace acdf::build
