// The cells of a stored tree, one by one: what exact summation and pictures are made from.
#pragma once

#include <acdf/reader.h>

#include <functional>

namespace acdf::measure {

/// A cell of a two-axis tree: ranges on axis 0 and 1 in grid positions, and its probability.
struct Cell {
    AcdfRange range[2];
    double probability = 0.0; ///< exactly what acdf_tree_sample returns there
};

/// Calls `visit` for every cell under `root`, those of probability 0 included. The cells partition
/// [0, columns) x [0, rows).
void for_each_cell(const File& file, std::uint32_t root, const std::function<void(const Cell&)>& visit);

} // namespace acdf::measure
