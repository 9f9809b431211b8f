// Grows a tree of halvings from the top, greedily (PAPER.md §8).
#pragma once

#include "compress/halvings/sums.h"

#include <cstdint>
#include <functional>
#include <limits>
#include <vector>

namespace acdf::compress {

/// A node: its box, what it costs as a leaf, and the axis it is halved on.
struct GrownNode {
    HalvedBox box;
    std::uint32_t lower = 0; ///< number of the lower half, which the upper one follows; 0: none
    float cost = 0.0f;
    std::int8_t axis = -1;
};

/// A tree, in the order in which its nodes were halved: the first n - 1 halvings make a tree of n leaves, whose
/// nodes are the first 2 n - 1.
struct GrownTree {
    std::vector<GrownNode> nodes;
    std::vector<double> cost; ///< sum of the costs of the leaves, for 1, 2, ... leaves

    std::size_t leaves() const { return cost.size(); }
    /// Whether a node is halved in the tree of so many leaves.
    bool is_halved(std::size_t node, std::size_t leaves) const {
        return nodes[node].lower != 0 && nodes[node].lower < 2 * leaves - 1;
    }
};

/// When growth ends.
struct GrowthLimits {
    std::size_t leaves = std::numeric_limits<std::size_t>::max();
    double cost = 0.0;     ///< once the sum of costs is not above it
    double heaviest = 0.0; ///< leaves with a larger weight are halved first; 0: no bound
    std::function<void(double)>
        done; ///< called now and then with the share of `leaves` that is there; may be empty
};

/// The weight of a leaf: the largest f / p in it over the mean of f / p, where the sum of costs is `cost`.
double leaf_weight(const HalvedSums& sums, const GrownNode& node, double cost, double integral);

/// Halves, until a limit is met or no leaf gains anything, the leaf that lowers the sum of costs most, on the
/// better axis, looking one level further: a third of what two halvings gain counts. `integral` is that of f.
GrownTree grow(const HalvedSums& sums, double integral, const GrowthLimits& limits);

} // namespace acdf::compress
