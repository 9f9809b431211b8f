// The cells of a stored tree, one by one: what exact summation and pictures are made from.
#pragma once

#include <acdf/curves/tree.h>
#include <acdf/reader.h>
#include <acdf/views.h>

#include <array>
#include <cstdint>
#include <functional>
#include <vector>

namespace acdf::build {

/// A cell of a tree of up to `Axes` axes: its range on each in grid positions, and its probability.
template <std::size_t Axes>
struct CellOf {
    AcdfTiltedRange range[Axes];
    double probability = 0.0; ///< exactly what acdf_tree_sample returns there
};
using Cell = CellOf<2>;

/// A cell's ranges without their tilts.
inline std::array<AcdfRange, 2> untilted(const AcdfTiltedRange* range) {
    return {acdf_untilted(&range[0]), acdf_untilted(&range[1])};
}

/// A cell of a table: its box on each sampled axis from 0, in grid positions, and its probability.
struct TableCell {
    AcdfSpan box[ACDF_MAX_AXES];
    double probability;
};

/// Calls `visit` for every cell of an environment, those of probability 0 included. The cells partition
/// [0, columns) x [0, rows).
void for_each_cell(const EnvironmentView& environment, const std::function<void(const Cell&)>& visit);
/// The same for the tree of curves under `root`.
void for_each_cell(const File& file, std::uint32_t root, const std::function<void(const Cell&)>& visit);

/// The boxes of the tiles of a local environment, in their order; none where it has no tiles.
std::vector<std::array<AcdfRange, 2>> tile_boxes(const File& file);

/// The same for what is in a tile of a local environment.
void for_each_tile_cell(const File& file, std::uint32_t tile, const std::function<void(const Cell&)>& visit);

/// The same for a bin of a table that has energy.
void for_each_table_cell(const File& file, std::uint32_t bin, const std::function<void(const TableCell&)>& visit);

} // namespace acdf::build
