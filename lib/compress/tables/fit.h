// The fit of a table: a tree of halvings for each bin that has energy (docs/method.md).
#pragma once

#include "compress/fit/fit.h"
#include "compress/grid.h"
#include "compress/halvings/halvings.h"

#include <cstdint>
#include <limits>
#include <vector>

namespace acdf::compress {

/// What the trees of a table are to reach.
struct TableFitOptions {
    Goal goal; ///< cells: in all bins
    /// How many bytes chunk HALV may have within a goal of bytes.
    std::uint64_t chunk_bytes = 0;
    /// A goal of variance is out of reach where it takes a larger chunk.
    std::uint64_t most_bytes = std::numeric_limits<std::uint64_t>::max();
    double max_weight = 0.0; ///< the largest f/p over its mean, in any bin; 0: no bound
    Progress progress;
};

/// The trees of a table, one after the other, and the root that each bin has in the file.
struct TableTrees {
    Halvings halvings;
    std::vector<std::uint32_t> roots;
};

/// The trees that have the least noise, a mean over the bins with energy, within the goal, with as many bits a code
/// as serve them best. Steps of the grids are even. Deterministic for any number of threads. Throws
/// std::invalid_argument where no bin has energy or the goal is 0 cells, and std::runtime_error where the goal is
/// out of reach: the message says what can be had.
TableTrees fit_table(const std::vector<Grid>& bins, const TableFitOptions& options);

/// Trees of one cell: the smallest that there are. `shares`: of each bin, 0 where it has no tree.
TableTrees whole_cells(const std::vector<float>& shares);

} // namespace acdf::compress
