// The target of an environment map on a grid of directions that need not be its own: what a pdf that is
// constant on the grid's texels is worth to a renderer that looks the map itself up, with its own filter.
#pragma once

#include "build/probe/projection.h"
#include "compress/target.h"

#include <cstdint>
#include <optional>

namespace acdf::build {

/// The grid that the positions of a file lie on.
struct Domain {
    AcdfParameterization parameterization = ACDF_PARAM_LATLONG;
    std::uint32_t columns = 0, rows = 0;

    bool operator==(const Domain& other) const {
        return parameterization == other.parameterization && columns == other.columns && rows == other.rows;
    }
};

/// The grid of a map's own texels, if a file can lie on it: of lat-long and octahedral maps.
std::optional<Domain> own_domain(const Map& map);

/// The map's own grid if it is one of that parameterization; else the next power of two at which no texel on the
/// equator is larger than the typical one of the map.
Domain domain_for(const Map& map, AcdfParameterization parameterization);

/// A target, and how far to trust it.
struct SourceTarget {
    compress::Target target;
    /// Bound on the relative error of E[(f/p)^2] that comes from cutting texels along borders that are straight in
    /// the one grid and curved in the other: the share of it whose position is not known exactly. 0 on the map's
    /// own grid.
    double error = 0.0;
};

/// g is the root mean square of f over what a texel of the grid overlaps of the map's, so that E[(f/p)^2] of a
/// pdf p that is constant on the grid is exact for the map, and no direction with light lies in a dark texel.
/// The integral of f is that over the map's texels. The same for any number of threads. Throws
/// std::invalid_argument on radiance that is not finite.
SourceTarget source_target(const Map& map, const float* rgb, const Domain& domain,
                           const compress::TargetOptions& options);

/// The target on the grid of either parameterization that loses least: where the best pdf that is constant on
/// its texels has less variance.
SourceTarget source_target_losing_least(const Map& map, const float* rgb, const compress::TargetOptions& options);

} // namespace acdf::build
