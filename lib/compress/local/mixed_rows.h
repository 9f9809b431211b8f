// Rows of a local environment map, made for the normals between its bins: they sample from mixtures of rows.
#pragma once

#include "compress/local/normals.h"
#include "compress/local/tile_light.h"

#include <acdf/layout.h>

#include <vector>

namespace acdf::compress {

/// One row a bin, one number a tile: its part of the irradiance over the integral of the target, as the mixture is
/// to take it. Empty where the bin is not stored.
using TileParts = std::vector<std::vector<float>>;

/// The rows whose mixtures have little variance at all normals. A corner's own best row lends light to its
/// neighbours that they do not see; where that samples many samples below a horizon, rows are held back further, so
/// that variance and samples in vain fall together. A part is positive wherever the corner sees light. `bins` are
/// those of an octahedron. The same for any number of threads.
TileParts mixed_rows(const TileLight& light, const NormalBins& bins,
                     const std::vector<AcdfBrightTile>& bright_tiles);

} // namespace acdf::compress
