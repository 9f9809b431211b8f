// From grown trees of a table to those of a file.
#pragma once

#include "compress/halvings/codes.h"
#include "compress/halvings/halvings.h"
#include "compress/tables/order.h"

#include <acdf/halvings.h>

#include <array>
#include <cstdint>
#include <vector>

namespace acdf::compress {

/// Makes the codes of trees. Leaves get the probability nearest to their share of all weights of their tree that
/// can be stored, but never 0 if they have any. A node whose random numbers are too few to be divided becomes a
/// leaf.
class TableCoder {
public:
    TableCoder(const TableCosts& costs, const TableOrder& order);

    /// The trees of the first `leaves` leaves; they are there until the next call.
    const Halvings& code(std::size_t leaves, const HalvingCodes& codes);

    // Of the trees that were made last, without an MIS partner.
    double relative_variance() const { return relative_variance_; } ///< of one sample, mean over the trees
    double max_weight() const { return max_weight_; }               ///< the largest f / p over the mean of f
    /// Of each tree the number of its first halving, or ACDF_NO_ROOT.
    const std::vector<std::uint32_t>& roots() const { return roots_; }

private:
    struct Part {
        std::uint32_t node;
        std::array<AcdfSpan, ACDF_MAX_AXES> steps;
    };

    void add_weights();
    bool is_halved(const TableNode& node) const { return node.lower != 0 && node.lower < weights_.size(); }
    bool divide(const TableNode& node, const HalvingCodes& codes, Part& lower, Part& upper);
    void end(const Part& part);
    void code_tree(std::uint32_t tree, const HalvingCodes& codes);

    const TableCosts& costs_;
    const std::vector<TableNode>& nodes_;
    std::vector<double> weights_; ///< of the nodes of the trees
    std::vector<Part> open_;
    std::vector<std::uint32_t> roots_;
    Halvings out_;
    double second_moment_ = 0.0, relative_variance_ = 0.0, max_weight_ = 0.0;
};

} // namespace acdf::compress
