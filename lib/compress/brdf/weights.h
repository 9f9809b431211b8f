// What bounds the weights of samples of a BRDF: the least that the rows of its views must give to each cell.
#pragma once

#include "compress/brdf/row_mixtures.h"
#include "compress/brdf/views.h"

#include <cstdint>
#include <vector>

namespace acdf::compress {

/// A square of half-vectors whose centre reflects below the horizon, and a part of which reflects above it. Cells
/// of nothing else are where the largest weights are: a fit that looks at centres alone takes them to be dark.
struct HorizonSquare {
    std::uint32_t square = 0;
    float peak = 0.0f;        ///< the pdf where the square rises first, in 1 / sr of half-vectors
    float mean_square = 0.0f; ///< of the pdf over the whole square
};

/// Squares at the horizon of one view, whose values are divided by `albedo` > 0.
std::vector<HorizonSquare> horizon_squares(const Reflected& reflected, const HalfGrid& grid, const View& view,
                                           double albedo);

using HorizonSquares = std::vector<std::vector<HorizonSquare>>; ///< one list a view

/// The horizon of all views, whose targets learn what light is there.
HorizonSquares look_at_horizon(const Reflected& reflected, BrdfViews& views);

/// A cell of a grid of half-vectors: its tile, and the share of the tile's samples that it gets from every row.
struct TileCell {
    std::uint32_t tile = 0;
    double share = 1.0;
};

/// The least probability of each tile for each view, as large as a bound on weights asks for in each of its cells.
class WeightBound {
public:
    /// `cell` of each square, in `cells`; these are of `tiles` tiles. A view needs what its neighbours need, too,
    /// as views between them are sampled from the same rows.
    WeightBound(const BrdfViews& views, const HorizonSquares& horizon, const std::vector<std::uint32_t>& cell,
                const std::vector<TileCell>& cells, std::size_t tiles, double max_weight);

    /// Raises rows in `wanted` by as much as mixtures of `rows` lack. Returns whether any lacks more than a
    /// hundredth.
    bool raise(const RowProbabilities& rows, const std::vector<SharedMixture>& mixtures,
               RowProbabilities& wanted) const;

private:
    std::vector<std::vector<double>> least_; ///< views x tiles
};

} // namespace acdf::compress
