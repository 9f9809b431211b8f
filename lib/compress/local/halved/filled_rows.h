// Rows of bins of normals beside an MIS partner that follows the cosine.
#pragma once

#include "compress/halvings/rows.h"
#include "compress/local/halved/filling.h"
#include "compress/local/halved/rows.h"

#include <acdf/layout.h>

#include <cstddef>
#include <vector>

namespace acdf::compress {

/// A cell of a tile: the integral of the square of its light, its measure and its share of the tile.
struct FilledCell {
    double square = 0.0, measure = 0.0, share = 0.0;
};

/// Where a mixture gives a tile the part P and its light has the cosine c, cells of density d have the second
/// moment of the integral of f^2 / (ratio P d + c / pi), or what the power heuristic makes of both: c times a sum
/// that P / c alone decides.
class FilledRows {
public:
    /// `cells`: of each tile. `light`: what normals that see it leave of each tile, as its cosines count.
    FilledRows(const BlockMoments& light, const std::vector<HalvedBox>& tiles,
               const std::vector<std::vector<FilledCell>>& cells, const NormalBins& bins,
               const Radiances& radiances, double ratio, AcdfHeuristic heuristic);

    /// A part is 0 where the partner covers the tile.
    RowParts parts() const;
    /// Of a bin whose row gives tiles so much: how to divide samples best, and its irradiance over that of `all`
    /// light.
    AcdfPartnerRecord record(std::size_t bin, const std::vector<float>& row, double all) const;

private:
    class Curve;

    std::vector<float> cosines(const BlockMoments& light, const Normals& normals) const;
    RowParts own(const std::vector<std::vector<FilledCell>>& cells) const;
    void add_mixture(std::size_t mixture, const RowParts& rows, float* falls, float& mean) const;

    const std::vector<HalvedBox>& tiles_;
    const NormalBins& bins_;
    const Mixtures mixtures_;
    const double ratio_;
    std::vector<LitNormal> lit_;               ///< of each bin
    std::vector<LitNormal> lit_mixture_;       ///< of each mixture
    std::vector<float> of_mixtures_, of_bins_; ///< cosines: of each, of each tile
    std::vector<std::size_t> place_;           ///< of each bin among those that are stored
    std::vector<float> scale_;                 ///< of each tile: what P / c is times, in its tables
    std::vector<float> moment_, fall_;         ///< of each tile at steps of P / c: the sum, and how fast it falls
    RowParts own_;
};

} // namespace acdf::compress
