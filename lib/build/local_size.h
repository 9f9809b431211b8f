// How many bins and tiles suit a local environment file of so many bytes, and what is left for what is in tiles.
#pragma once

#include "build/local.h"
#include "compress/local/fit.h"

#include <cstdint>

namespace acdf::build {

/// Bins as options tell, of so many subdivisions if they tell none.
compress::NormalBins bins_of(const LocalOptions& options, std::uint32_t subdivisions);

/// Bins for a file of `bytes`. For the few normals of a scene they can be denser at the same cost.
compress::NormalBins bins_for(const LocalOptions& options, double bytes);

/// What of a file should be inside tiles.
double inside_share(compress::LocalShape shape);
/// Bytes of a cell there, about.
double bytes_of_cell(compress::LocalShape shape);

/// Tiles, and curves or grids in them, that fill a budget; tiles take all but `inside` of the bytes that there are
/// for both.
compress::LocalSize size_for(const LocalOptions& options, const compress::NormalBins& bins, double bytes,
                             double inside);
compress::LocalSize size_for(const LocalOptions& options, const compress::NormalBins& bins, double bytes);

} // namespace acdf::build
