// How many bins and tiles suit a local environment file of a number of bytes, and how many bytes are left for the
// insides of tiles.
#pragma once

#include "build/local.h"
#include "compress/local/fit.h"

#include <cstdint>

namespace acdf::build {

/// Bins by the options; of so many subdivisions if those name none.
compress::NormalBins bins_of(const LocalOptions& options, std::uint32_t subdivisions);

/// The same; for the few normals of a scene so dense that as many are stored.
compress::NormalBins bins_as_many(const LocalOptions& options, std::uint32_t subdivisions);

/// Bins for a file of `bytes`. For the few normals of a scene they can be denser at the same cost.
compress::NormalBins bins_for(const LocalOptions& options, double bytes);

/// Tiles, and curves in them, that fill a budget: what else there is than a tree of the environment alone.
compress::LocalSize size_for(const LocalOptions& options, const compress::NormalBins& bins, double bytes);
/// Tiles for what is inside them, and so many bytes of that.
compress::LocalSize size_around(const LocalOptions& options, const compress::NormalBins& bins, double inside_bytes);
/// The bytes of a file that has so many inside tiles, about.
double bytes_around(double inside_bytes);
constexpr double kBytesOfCell = 4.2; ///< inside tiles, about

} // namespace acdf::build
