// What lies in the tiles of a local environment map, as bright tiles and rows of probabilities see it: cells of
// curves (tile_curves.h).
#pragma once

#include "compress/fit/projection.h"

#include <cstddef>
#include <vector>

namespace acdf::compress {

/// A cell of a tile, or a few small ones beside each other.
struct LitCell {
    Box box;
    /// The integral of (g cos)^2 / p within it is this times cos^2, for the pdf p within the tile.
    double amount = 0.0;
    double weight = 0.0; ///< see Moments; 0 where no bound on weights is kept
};

class TileInsides {
public:
    virtual ~TileInsides() = default;

    /// The root of the sum of the amounts of its cells: the integral of its light, and what its pdf within
    /// adds.
    virtual double tile_cost(std::size_t tile) const = 0;
    /// The cells of a tile that have light.
    virtual std::vector<LitCell> lit_cells(std::size_t tile) const = 0;
};

} // namespace acdf::compress
