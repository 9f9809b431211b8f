// A probe divided into strata: the importance metric, thresholds and placement of Agarwal, Ramamoorthi, Belongie,
// Jensen, "Structured Importance Sampling of Environment Maps", SIGGRAPH 2003.
#pragma once

#include "compress/target.h"

#include <cstdint>
#include <vector>

namespace acdf::measure {

/// The stratum of each texel, rows x columns, numbers from 0 without gaps; at most `strata`, which is fewer than
/// that only where there are fewer texels to divide.
///
/// Radiance is cut at 0, 1, ... 5 standard deviations. From the highest cut down, each connected region above it
/// asks for its share of the strata by its metric, flux * min(solid angle, 0.01)^(1/4), less those that it holds
/// already; its new points are placed each as far as possible from all others (Hochbaum and Shmoys, Mathematics of
/// Operations Research 10(2), 1985). Strata are Voronoi cells of the points.
///
/// Simplified: a region's first point is its brightest texel, shares are rounded, no texel is divided, and a texel
/// goes to the nearest of those points that were placed with the first cut at which its region got any, so that
/// strata of a light do not reach into what surrounds it.
///
/// Throws std::invalid_argument for no strata, and where the target is no probe or black.
std::vector<std::uint32_t> stratify(const compress::Target& target, std::uint32_t strata);

} // namespace acdf::measure
