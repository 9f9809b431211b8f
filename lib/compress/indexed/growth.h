// Grows a tree for several maps: at the top each halving serves all maps by codes of their own, below they share.
#pragma once

#include "compress/halvings/sums.h"

#include <cstdint>
#include <memory>
#include <vector>

namespace acdf::compress {

/// The sums of several maps of one grid.
class IndexedSums {
public:
    /// `weights`: what relative noise of a map counts.
    IndexedSums(const std::vector<Grid>& grids, const std::vector<double>& weights);

    std::size_t maps() const { return sums_.size(); }
    const HalvedSums& shape() const { return *sums_[0]; }
    /// What a box costs in a map: relative to the least that the map can cost, times its weight.
    double cost(std::size_t map, const HalvedBox& box) const { return scale_[map] * sums_[map]->alone(box); }
    double cost(const HalvedBox& box) const {
        double sum = 0.0;
        for (std::size_t map = 0; map < maps(); ++map) sum += cost(map, box);
        return sum;
    }
    double weight(std::size_t map) const { return weights_[map]; }

private:
    std::vector<std::unique_ptr<HalvedSums>> sums_;
    std::vector<double> weights_, scale_;
};

/// A node of the tree.
struct IndexedNode {
    HalvedBox box;
    std::uint32_t lower = 0; ///< number of the lower half, which the upper one follows; 0: none
    double cost = 0.0;       ///< of all maps; below a tile, by its own measure
    std::int8_t axis = -1;
};

/// In the order in which nodes were halved.
struct IndexedGrowth {
    std::vector<IndexedNode> nodes;
    std::size_t top = 0; ///< how many halvings, the first ones, have codes of each map
};

/// The first `halvings` halvings that lower the sum of the costs of all maps most, looking one level further.
IndexedGrowth grow_top(const IndexedSums& sums, std::size_t halvings);

/// The first `top` halvings of `grown`, and `shared` more below them that lower what maps cost with shares in
/// common.
IndexedGrowth grow_shared(const IndexedSums& sums, const IndexedGrowth& grown, std::size_t top, std::size_t shared);

} // namespace acdf::compress
