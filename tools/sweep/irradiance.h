// Exact variances of irradiance estimates from a density that is known at every texel.
#pragma once

#include "build/local_accuracy.h"
#include "compress/target.h"
#include "measure/light_sampler.h"

#include <functional>
#include <vector>

namespace acdf::tools {

/// The density of a sampler that does not know the normal, in sr^-1, in the middle of each texel (its z halves the
/// texel's solid angle).
std::vector<float> texel_densities(const compress::Target& target, const measure::LightSampler& sampler);

/// Over normals that see any light.
struct MeanAndWorst {
    double mean = 0.0, worst = 0.0;
};

/// Relative variance of one sample of the irradiance L max(0, n . omega) drawn with density
/// (1 - cosine_share) p + cosine_share max(0, n . omega) / pi, by summation over texels with each one's cosine in
/// its middle. Infinite where light has no density. L^2 is the target's mean square over a texel. The same for any
/// number of threads.
MeanAndWorst irradiance_variance(const compress::Target& target, const std::vector<float>& density,
                                 double cosine_share, const std::vector<build::Normal>& normals);

/// Mean and worst of what `variance` gives for each normal, which several threads ask at once.
MeanAndWorst over_normals(const std::vector<build::Normal>& normals,
                          const std::function<double(const float n[3])>& variance);

} // namespace acdf::tools
