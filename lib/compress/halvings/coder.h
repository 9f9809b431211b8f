// From a grown tree to that of a file.
#pragma once

#include "compress/halvings/codes.h"
#include "compress/halvings/growth.h"
#include "compress/halvings/halvings.h"

#include <acdf/halvings.h>

#include <array>
#include <cstdint>
#include <vector>

namespace acdf::compress {

/// Makes the codes of trees, in memory that is used again. Leaves get the probability nearest to their share of all
/// weights (HalvedCosts::weight) that can be stored, but never 0 if they have any. A node whose random numbers are
/// too few to be divided becomes a leaf.
class TreeCoder {
public:
    /// `axes`: numbers in the file of what is axis 0 of the grid, the rows, and axis 1. `least_steps`: of random
    /// numbers on an axis, those that a cell has at least.
    explicit TreeCoder(std::array<std::uint32_t, 2> axes, std::uint32_t least_steps = kStepsOfFloats);

    /// Takes the memory of trees of so many leaves.
    void reserve(std::size_t leaves);
    /// The tree of the first `leaves` leaves; it is there until the next call.
    const Halvings& code(const HalvedCosts& costs, const HalvedGrowth& grown, std::size_t leaves,
                         std::uint32_t code_bits);
    /// The same of a tree of one leaf.
    const Halvings& leaf();

    // Of the tree that was made last.
    /// Relative variance of one sample.
    double relative_variance() const { return relative_variance_; }
    double max_weight() const { return max_weight_; } ///< the largest f / p over the mean of f

private:
    struct Part {
        std::uint32_t node;
        AcdfSpan steps[2];
    };

    const HalvingCodes& codes_of(std::uint32_t bits) const;
    void add_weights(const HalvedCosts& costs, const std::vector<HalvedNode>& nodes);
    bool is_halved(const HalvedNode& node) const { return node.lower != 0 && node.lower < weights_.size(); }
    bool divide(const HalvedNode& node, const HalvingCodes& codes, Part& lower, Part& upper);

    std::array<std::uint32_t, 2> axes_;
    std::uint32_t least_steps_;
    std::vector<HalvingCodes> codes_;
    std::vector<double> weights_; ///< of the nodes of the tree
    std::vector<Part> open_;
    Halvings out_;
    double relative_variance_ = 0.0, max_weight_ = 0.0;
};

} // namespace acdf::compress
