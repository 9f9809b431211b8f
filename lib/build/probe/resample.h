// Resamples an environment map of any layout to lat-long, once, with every texel's energy kept.
#pragma once

#include "build/probe/projection.h"

#include <vector>

namespace acdf::build {

/// `rgb` (map.height x map.width x 3, finite, >= 0) as lat-long of `width` x width / 2 x 3, `width` a power of
/// two >= 4 (see latlong_width).
///
/// Both images are constant on each texel. A lat-long texel becomes the mean of the source over its solid
/// angle; then each source texel's share is scaled (by about 1) so that it hands out exactly L times its own
/// solid angle: the integral over the sphere is kept to rounding, also of a single bright texel. `rgb` is
/// used up. The result does not depend on `threads` (0: all cores).
std::vector<float> resample_to_latlong(const Map& map, std::vector<float> rgb, int width, int threads);

} // namespace acdf::build
