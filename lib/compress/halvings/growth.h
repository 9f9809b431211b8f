// Grows a tree of halvings from the top, many leaves at a time (PAPER.md §8).
#pragma once

#include "compress/halvings/costs.h"

#include <cstddef>
#include <cstdint>
#include <functional>
#include <limits>
#include <vector>

namespace acdf::compress {

/// A node: its box, what it costs as a leaf, and the axis that it is best halved on.
struct HalvedNode {
    HalvedBox box;
    std::uint32_t lower = 0; ///< number of the lower half, which the upper one follows; 0: a leaf
    float cost = 0.0f;
    float gain = 0.0f;     ///< what halving it gains
    std::int8_t axis = -1; ///< 0: rows, 1: columns; -1: none gains anything
};

/// What a tree is to be: so many bits a code, and the most leaves that codes of so many bits may have.
struct TreeSize {
    std::uint32_t code_bits;
    std::size_t leaves;
};

/// How much growth takes care, and when it ends.
struct GrowthLimits {
    /// Leaves of a round gain at least so much of the largest gain. 1: the leaves are halved one after the other.
    float alike = 0.5f;
    double cost = 0.0;     ///< it ends once the sum of costs is not above it
    double heaviest = 0.0; ///< leaves with a larger weight are halved first; 0: no bound
};

/// Halves, in rounds, the leaves that lower the sum of costs most, each on its better axis, looking one level
/// further: a third of what two halvings gain counts. Halves of a node follow it, and the first 2 n - 1 nodes are a
/// tree of n leaves.
class HalvedGrowth {
public:
    /// `sizes`: from the most bits, and the fewest leaves, on.
    explicit HalvedGrowth(std::vector<TreeSize> sizes, GrowthLimits limits = {});

    /// Takes the memory of the largest tree, so that run() takes none.
    void reserve();
    /// Grows the tree. `round` is called after each with the share that is there; it may be empty.
    void run(const HalvedCosts& costs, const Loop& loop, const std::function<void(double)>& round);
    /// Goes on from a tree, or several: from those of `top` whose `lower` is 0, and by these costs.
    void run_below(std::vector<HalvedNode> top, const HalvedCosts& costs, const Loop& loop,
                   const std::function<void(double)>& round);

    const std::vector<HalvedNode>& nodes() const { return nodes_; }
    std::size_t leaves() const { return totals_.size(); }
    /// What the first so many leaves cost together.
    double cost(std::size_t leaves) const { return totals_[leaves - 1]; }
    std::uint32_t code_bits() const { return size_.code_bits; } ///< that suit the tree

private:
    void clear();
    void begin(const HalvedCosts& costs);
    void grow(const HalvedCosts& costs, const Loop& loop, const std::function<void(double)>& round);
    void look_later(const HalvedCosts& costs, std::uint32_t node);
    bool is_reached() const { return totals_.back() <= limits_.cost && heavy_ == 0; }
    bool is_heavy(const HalvedCosts& costs, const HalvedNode& node) const;
    void look(const HalvedCosts& costs, HalvedNode& node) const;
    std::size_t choose();
    std::uint64_t rank(const std::vector<std::uint64_t>& of, std::size_t count);
    static void move(std::vector<std::uint64_t>& from, std::uint64_t least, std::vector<std::uint64_t>& to);
    void halve(const HalvedCosts& costs, const Loop& loop);
    void predict(const HalvedCosts& costs);

    std::vector<TreeSize> sizes_;
    GrowthLimits limits_;
    TreeSize size_;
    bool predicted_ = false;
    std::vector<HalvedNode> nodes_;
    /// Keys of leaves: gain and number. Those of `next_` are not below `least_`, those of `later_` are.
    std::vector<std::uint64_t> next_, later_, chosen_, ranked_;
    std::uint64_t least_ = 0;
    std::size_t heavy_ = 0;      ///< leaves that are to be halved whatever they gain
    std::vector<double> totals_; ///< of the costs of 1, 2, ... leaves
};

/// The weight of a leaf, which is the largest f / p in it over the mean of f / p, where all leaves cost `total`.
inline double leaf_weight(const HalvedCosts& costs, const HalvedNode& leaf, double total) {
    return leaf.cost > 0.0f ? costs.peak(leaf.box) * total / double{leaf.cost} : 0.0;
}

} // namespace acdf::compress
