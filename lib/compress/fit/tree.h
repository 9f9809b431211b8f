// The variance fit as a general tree, for any number of axes and bins.
#pragma once

#include "compress/fit/fit.h"
#include "compress/grid.h"

#include <vector>

namespace acdf::compress {

/// The minimum-variance trees of all bins, one root each, for one goal: a byte goes to the bin in which it lowers
/// the relative variance most. Bins without energy get a single cell. `options.order` forces axis 0 (z) or 1 (phi)
/// of the grids first. Deterministic for any number of threads. Throws std::runtime_error where the goal is out of
/// reach.
Fitted fit_trees(const std::vector<Grid>& bins, const FitOptions& options);

} // namespace acdf::compress
