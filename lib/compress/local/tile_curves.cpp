#include "compress/local/tile_curves.h"
#include "compress/parallel.h"

#include <acdf/sample.h>

#include <limits>

namespace acdf::compress {

TileCurves::TileCurves(const Target& target, const std::vector<Box>& tiles, std::vector<double> worth,
                       double heaviest)
    : worth_(std::move(worth)), heaviest_(heaviest), total_(integral(target)), partitions_(tiles.size()),
      nodes_(tiles.size()) {
    parallel_for(std::size_t{0}, tiles.size(), [&](std::size_t t) {
        partitions_[t] =
            std::make_unique<Partition>(grid_of(target), total_, tiles[t], std::uint8_t{TileTree::most_depth + 1});
        look_at(t);
    });
}

void TileCurves::look_at(std::size_t tile) {
    nodes_[tile] = prune_nodes(partitions_[tile]->parts(), heaviest_, partitions_[tile]->grid().filling);
}

void TileCurves::refine(double price) {
    parallel_for(std::size_t{0}, partitions_.size(), [&](std::size_t t) {
        if (!(worth_[t] > 0.0)) return;
        partitions_[t]->refine(price * kLeastBytes / (worth_[t] * total_), heaviest_);
        look_at(t);
    });
}

Pruned TileCurves::pruned(std::size_t tile, double price) const {
    const double own = worth_[tile] > 0.0 ? price / (worth_[tile] * total_) : std::numeric_limits<double>::max();
    return prune(nodes_[tile], own);
}

double TileCurves::cost(std::size_t tile, const Pruned& pruned) const {
    const Filling* filling = partition(tile).grid().filling;
    double out = 0.0;
    for_each_cell(partition(tile).parts(), pruned, [&](const Part& part) { out += part.moments.share(filling); });
    return out;
}

TileCascade::TileCascade(const TileTree& tiles, const TileCurves& curves, double price, WholeTree whole)
    : tile_curve(tiles.tiles.size(), -1), tiles_(tiles), curves_(curves), pruned_(tiles.tiles.size()),
      cost_(tiles.tiles.size(), 0.0), split_cost_(tiles.splits.size()) {
    parallel_for(std::size_t{0}, tiles.tiles.size(), [&](std::size_t t) {
        pruned_[t] = curves.pruned(t, price);
        cost_[t] = curves.cost(t, pruned_[t]);
    });
    for (std::size_t s = tiles.splits.size(); s-- > 0;)
        split_cost_[s] = child_cost(tiles.splits[s].child[0]) + child_cost(tiles.splits[s].child[1]);
    if (whole == WholeTree::own) {
        add_tiles();
        return;
    }
    cascade.roots = {0};
    add(tiles.splits.empty() ? TileTree::tile : 0);
}

std::vector<LitCell> TileCascade::lit_cells(std::size_t tile) const {
    std::vector<LitCell> out;
    for_each_cell(tile, [&](const Part& part) {
        // A cell of measure mu and probability P within the tile, P = cost of cell / cost of tile, adds mu / P
        // times the integral of g^2 cos^2: cost of tile . cost of cell . cos^2.
        const double amount = cost_[tile] * part.moments.cost();
        if (amount > 0.0) out.push_back({part.box, amount, part.moments.weight()});
    });
    return out;
}

std::int32_t TileCascade::add(std::uint32_t child) {
    return child & TileTree::tile ? add_tile(child & ~TileTree::tile, WholeTree::of_tiles) : add_split(child);
}

void TileCascade::add_tiles() {
    double sum = 0.0;
    for (const double cost : cost_) sum += cost;
    for (std::uint32_t t = 0; t < cost_.size(); ++t) {
        const std::int32_t curve = cost_[t] > 0.0 ? add_tile(t, WholeTree::own) : -1;
        if (curve < 0) continue;
        TileRoot root{static_cast<std::uint32_t>(curve), cost_[t] / sum, {}};
        root.low[ACDF_AXIS_THETA] = tiles_.tiles[t].begin[0];
        root.low[ACDF_AXIS_PHI] = tiles_.tiles[t].begin[1];
        cascade.tiles.push_back(root);
    }
}

std::int32_t TileCascade::add_tile(std::uint32_t tile, WholeTree whole) {
    const auto index = static_cast<std::int32_t>(cascade.curves.size());
    const bool needs_curve = whole == WholeTree::of_tiles && index == 0; // the root of the environment
    if (!pruned_[tile].divided[0] && !needs_curve) return -1;
    Flattened inside;
    flatten(curves_.partition(tile), curves_.nodes(tile), pruned_[tile], inside);
    for (Curve& curve : inside.cascade.curves) {
        for (std::int32_t& c : curve.children)
            if (c >= 0) c += index;
        cascade.curves.push_back(std::move(curve));
    }
    return tile_curve[tile] = index;
}

std::int32_t TileCascade::add_split(std::uint32_t s) {
    const TileTree::Split& split = tiles_.splits[s];
    const std::size_t index = cascade.curves.size();
    cascade.curves.emplace_back();
    Curve curve;
    curve.axis = split.axis == 0 ? ACDF_AXIS_THETA : ACDF_AXIS_PHI;
    curve.knots = {split.position};
    for (std::uint32_t child : split.child) {
        const double cost = child_cost(child);
        curve.probability.push_back(split_cost_[s] > 0.0 ? cost / split_cost_[s] : 0.5);
        curve.children.push_back(cost > 0.0 ? add(child) : -1);
    }
    cascade.curves[index] = std::move(curve);
    return static_cast<std::int32_t>(index);
}

} // namespace acdf::compress
