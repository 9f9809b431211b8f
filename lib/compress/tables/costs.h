// What boxes of the bins of a table cost.
#pragma once

#include "compress/grid.h"
#include "compress/tables/box_sums.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace acdf::compress {

/// A node of a tree: what its box holds, and the axis that it is best halved on. A bin has a measure of 1, and an
/// integral of f of 1. There are many nodes: the box itself follows from those above.
struct TableNode {
    double alone = 0.0;       ///< root of its measure times the integral of f^2
    double left = 0.0;        ///< twice what it costs to leave it to an MIS partner; 0: there is none
    float promise = 0.0f;     ///< what halving it may lower the costs by
    float peak = 0.0f;        ///< the largest f times its measure; 0: nobody asks
    std::uint32_t parent = 0; ///< of a root itself
    std::uint32_t lower = 0;  ///< number of the lower half, which the upper one follows; 0: a leaf
    std::uint32_t tree = 0;   ///< number of the tree
    std::int8_t axis = -1;    ///< -1: halving it is of no use
    bool heavy = false;       ///< its weight as a leaf is above the bound

    double cost() const { return cell_cost(alone, left); } ///< as a leaf
};

/// Bins that have energy, each with an integral of 1.
class TableCosts {
public:
    /// `bins` must outlive this; their steps are even. `heaviest`: the largest weight of a leaf; 0: no bound.
    TableCosts(const std::vector<Grid>& bins, double heaviest);

    std::size_t trees() const { return bins_.size(); }
    std::size_t bin_of(std::size_t tree) const { return bins_[tree].number; }
    std::size_t axes() const { return bins_.front().grid->dimensions(); }
    std::size_t numbers() const { return numbers_; } ///< of all
    bool has_partner() const { return bins_.front().grid->left != nullptr; }
    /// The whole of a tree.
    TableNode root(std::uint32_t tree) const;
    /// The halves of one of `nodes`.
    std::array<TableNode, 2> halves_of(const std::vector<TableNode>& nodes, std::uint32_t node) const;
    /// The share of samples that a node should get as a leaf, in proportion.
    double weight(const TableNode& node) const;

private:
    struct Bin {
        const Grid* grid;
        std::size_t number;
        double count, sum; ///< how many numbers there are, and their sum
    };

    TableBox whole(std::uint32_t tree) const;
    TableBox box_of(const std::vector<TableNode>& nodes, std::uint32_t node) const;
    void look(const TableBox& box, TableNode& node) const;

    std::vector<Bin> bins_;
    std::size_t numbers_ = 0;
    double heaviest_;
};

} // namespace acdf::compress
