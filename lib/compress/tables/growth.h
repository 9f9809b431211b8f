// Grows the trees of halvings of a table's bins from the top (PAPER.md §8).
#pragma once

#include "compress/tables/costs.h"

#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <vector>

namespace acdf::compress {

/// Trees that grow: roots come first, then the halves of each node that is halved. In rounds the leaves are halved
/// that promise about as much, the most of all, to lower the relative variance, a mean over the trees.
/// Deterministic for any number of threads.
class TableGrowth {
public:
    explicit TableGrowth(const TableCosts& costs);

    /// Goes on until there are so many leaves, or the variance is not above `enough` and no leaf is too heavy.
    void run(std::size_t leaves, double enough, const std::function<void(double)>& progress);

    const std::vector<TableNode>& nodes() const { return nodes_; }
    std::size_t leaves() const { return (nodes_.size() + of_tree_.size()) / 2; }
    /// The sum of the costs of a tree, which is the root of its second moment.
    double cost(std::size_t tree) const { return of_tree_[tree]; }

private:
    void wait(std::uint32_t node);
    std::vector<std::uint32_t> next(std::size_t most);
    void halve(const std::vector<std::uint32_t>& leaves);
    double variance() const;

    const TableCosts& costs_;
    std::vector<TableNode> nodes_;
    /// Leaves that may be halved, by how much they promised when they came.
    std::map<int, std::vector<std::uint32_t>, std::greater<>> waiting_;
    std::vector<double> of_tree_;
    std::size_t heavy_ = 0;
};

} // namespace acdf::compress
