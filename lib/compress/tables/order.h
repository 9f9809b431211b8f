// The order in which halvings of grown trees pay best.
#pragma once

#include "compress/tables/growth.h"

#include <cstddef>
#include <cstdint>
#include <vector>

namespace acdf::compress {

/// The nodes of grown trees, numbered anew: roots come first, halves of a node follow it, and the first
/// 2 n - trees nodes are the trees of n leaves that cost least, for every n at which a further halving pays less
/// than those before. No halving comes before that of its parent.
class TableOrder {
public:
    explicit TableOrder(const TableGrowth& grown, std::size_t trees);

    const std::vector<TableNode>& nodes() const { return nodes_; }
    std::size_t leaves() const { return variances_.size() - 1 + trees_; }
    /// Relative variance of the first so many leaves, a mean over the trees, with shares in proportion to weights.
    /// Beside an MIS partner that of costs.
    double variance(std::size_t leaves) const { return variances_[leaves - trees_]; }

private:
    std::size_t trees_;
    std::vector<TableNode> nodes_;
    std::vector<double> variances_;
};

} // namespace acdf::compress
