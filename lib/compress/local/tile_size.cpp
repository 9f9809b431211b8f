#include "compress/local/tile_size.h"
#include "compress/parallel.h"

#include <algorithm>
#include <array>

namespace acdf::compress {

/// A tree on its way to be placed. Curves come in the order in which TileCascade has them.
struct TileSizer::Tree {
    static constexpr std::uint32_t none = SizedCurve::none;
    using Lows = std::array<std::uint32_t, 2>; ///< where a box begins on the axes of the grid

    TileSizer& sizer;
    double byte_price;
    std::vector<double> split_cost;
    std::vector<CurveShape> shapes{};
    std::vector<std::uint32_t> last_child{};

    double cost(std::uint32_t child) const {
        return child & TileTree::tile ? sizer.inside_[child & ~TileTree::tile].cost : split_cost[child];
    }
    /// Its first curve, or `none`. `reach`: how often sampling comes to it.
    std::uint32_t add(std::uint32_t child, double reach, const Lows& low) {
        return child & TileTree::tile ? add_tile(sizer.inside_[child & ~TileTree::tile], reach)
                                      : add_split(child, reach, low);
    }
    /// All tiles, and nothing above them.
    void add_tiles() {
        double sum = 0.0;
        for (const Inside& inside : sizer.inside_) sum += inside.cost;
        for (Inside& inside : sizer.inside_)
            if (inside.cost > 0.0) add_tile(inside, inside.cost / sum);
    }

private:
    std::uint32_t add_tile(Inside& inside, double root_reach) {
        const bool needs_curve = sizer.whole_ == WholeTree::of_tiles && shapes.empty(); // the environment's root
        if (!inside.divided[0] && !needs_curve) return none;
        const auto base = static_cast<std::uint32_t>(shapes.size());
        std::vector<double> reach;
        for (std::size_t c = 0; c < inside.curves.curves.size(); ++c) {
            const SizedCurve& curve = inside.curves.curves[c];
            reach.push_back(curve.parent == none ? root_reach : reach[curve.parent] * curve.of_parent);
            const auto rounding = [&](std::uint32_t code) {
                return inside.roundings[c].to(code, inside.curves, curve);
            };
            put(curve.shape, curve.lit, reach.back(), rounding);
            last_child.push_back(base + curve.last_child);
        }
        return base;
    }

    std::uint32_t add_split(std::uint32_t s, double reach, Lows low) {
        const TileTree::Split& split = sizer.tiles_.splits[s];
        const auto index = static_cast<std::uint32_t>(shapes.size());
        std::vector<double> probability;
        for (const std::uint32_t child : split.child)
            probability.push_back(split_cost[s] > 0.0 ? cost(child) / split_cost[s] : 0.5);
        CurveShape shape;
        shape.segments = 2;
        shape.position_code = position_code(split.position, low[split.axis], true);
        put(shape, std::uint64_t(probability[0] > 0.0) + std::uint64_t(probability[1] > 0.0), reach,
            [&](std::uint32_t code) { return rounding_to(probability, code); });
        last_child.push_back(none);
        for (std::size_t k = 0; k < 2; ++k) {
            if (k > 0) low[split.axis] = split.position;
            if (!(cost(split.child[k]) > 0.0)) continue;
            const std::uint32_t child = add(split.child[k], reach * probability[k], low);
            if (child == none) continue;
            shapes[index].link_code = 1;
            last_child[index] = child; // later ones lie farther away
        }
        return index;
    }

    template <class RoundingOf>
    void put(CurveShape shape, std::uint64_t lit, double reach, const RoundingOf& rounding) {
        shape.probability_code =
            best_width(shape.segments - 1, lit, reach, byte_price, sizer.most_ratio_, rounding);
        shapes.push_back(shape);
    }
};

TileSizer::TileSizer(const TileTree& tiles, const TileCurves& curves, double most_ratio, WholeTree whole,
                     std::size_t before)
    : tiles_(tiles), curves_(curves), most_ratio_(most_ratio), whole_(whole), before_(before),
      inside_(tiles.tiles.size()) {}

void TileSizer::forget() {
    for (Inside& inside : inside_) inside = {};
}

void TileSizer::prune(double price) {
    parallel_for(std::size_t{0}, inside_.size(), [&](std::size_t t) {
        Inside& inside = inside_[t];
        Pruned pruned = curves_.pruned(t, price);
        if (pruned.divided == inside.divided) return;
        if (inside.begins.empty()) inside.begins = begins_of(curves_.partition(t).parts());
        inside.cost = curves_.cost(t, pruned);
        inside.curves = sized_curves(curves_.nodes(t), inside.begins, pruned);
        inside.roundings.assign(inside.curves.curves.size(), {});
        inside.divided = std::move(pruned.divided);
    });
}

std::uint64_t TileSizer::bytes(double price, double byte_price) {
    prune(price);
    Tree tree{*this, byte_price, std::vector<double>(tiles_.splits.size())};
    const auto farthest = [&](std::size_t i, const auto& test) { return test(std::size_t{tree.last_child[i]}); };
    const auto end = [&] { return place(tree.shapes, farthest, before_).back(); }; // asks only of curves with links
    if (whole_ == WholeTree::own) {
        tree.add_tiles();
        return end();
    }
    for (std::size_t s = tiles_.splits.size(); s-- > 0;)
        tree.split_cost[s] = tree.cost(tiles_.splits[s].child[0]) + tree.cost(tiles_.splits[s].child[1]);
    tree.add(tiles_.splits.empty() ? TileTree::tile : 0, 1.0, {});
    return end();
}

} // namespace acdf::compress
