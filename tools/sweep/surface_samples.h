// Variances of what a diffuse surface reflects where a renderer's numbers are not independent: by sampling samples.
#pragma once

#include "measure/map_lookup.h"
#include "tools/sweep/surface.h"

#include <cstdint>
#include <vector>

namespace acdf::tools {

struct SampledVariances {
    double alone = 0.0, partner = 0.0;
};

/// The variance of an estimate of `samples` (rounded up to an even number) scrambled Sobol' points times their
/// number, over E^2 as `summary` scales it, mean over points. With independent numbers it would be that of `exact`,
/// which is of the same points. Over `seeds` (at least 2) estimates. With an MIS partner half of the samples are
/// the cosine's. `light` is what they find. The same for any number of threads.
SampledVariances sobol_variances(const compress::Target& target, const measure::MapLight& light,
                                 const measure::LightSampler& sampler, const std::vector<SurfacePoint>& points,
                                 const std::vector<PointVariance>& exact, Scale scale, std::uint32_t samples,
                                 std::uint32_t seeds);

/// Of the samples alone: variance times samples over each point's own E^2, mean over points. `irradiances` are
/// those of the points, by summation.
double sobol_variance(const compress::Target& target, const measure::MapLight& light,
                      const measure::LightSampler& sampler, const std::vector<SurfacePoint>& points,
                      const std::vector<double>& irradiances, std::uint32_t samples, std::uint32_t seeds);

} // namespace acdf::tools
