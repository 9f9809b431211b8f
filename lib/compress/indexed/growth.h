// Grows a tree for several maps: at the top each halving serves all maps by codes of their own, below they share.
#pragma once

#include "compress/halvings/growth.h"
#include "compress/halvings/sums.h"

#include <cstdint>
#include <memory>
#include <vector>

namespace acdf::compress {

/// The sums of several maps of one grid; as costs those of all maps together.
class IndexedSums final : public HalvedCosts {
public:
    /// `weights`: what relative noise of a map counts.
    IndexedSums(const std::vector<Grid>& grids, const std::vector<double>& weights);

    std::size_t maps() const { return sums_.size(); }
    /// What a box costs in a map: relative to the least that the map can cost, times its weight.
    double cost(std::size_t map, HalvedBox box) const { return scale_[map] * sums_[map]->alone(box); }
    float cost(HalvedBox box) const override {
        double sum = 0.0;
        for (std::size_t map = 0; map < maps(); ++map) sum += cost(map, box);
        return static_cast<float>(sum);
    }
    double least_square() const override { return least_ * least_; }
    std::uint32_t file_axis(std::size_t axis) const { return file_axes_[axis]; }
    double weight_of(std::size_t map) const { return weights_[map]; }

private:
    const std::vector<std::uint32_t> file_axes_;
    const HalvedAxes axes_;
    std::vector<std::unique_ptr<HalvedSums>> sums_;
    std::vector<double> weights_, scale_;
    double least_; ///< the sum of weights
};

/// In the order in which nodes were halved.
struct IndexedGrowth {
    std::vector<HalvedNode> nodes; ///< below a tile costs are by its own measure
    std::size_t top = 0;           ///< how many halvings, the first ones, have codes of each map
};

/// The first `halvings` halvings that lower the sum of the costs of all maps most, looking one level further.
IndexedGrowth grow_top(const IndexedSums& sums, std::size_t halvings);

/// The first `top` halvings of `grown`, and `shared` more below them that lower what maps cost with shares in
/// common.
IndexedGrowth grow_shared(const IndexedSums& sums, const IndexedGrowth& grown, std::size_t top, std::size_t shared);

} // namespace acdf::compress
