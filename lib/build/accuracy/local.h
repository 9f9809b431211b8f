// How far a local environment map is from its target, by summation over every texel, for given normals.
#pragma once

#include "compress/local/normals.h"
#include "compress/target.h"

#include <acdf/accuracy.h>
#include <acdf/reader.h>
#include <acdf/views.h>

#include <array>
#include <cstdint>
#include <vector>

namespace acdf::build {

using Normal = std::array<float, 3>;

/// Accuracy for one normal n: f = g max(0, n . omega), with the cosine at the centres of texels (see FineTexels); p
/// the stored pdf, sr^-1. g^2 is that of compress::Target: with a filter or several channels, a texel's mean
/// square; means of f are those of compress::Target::means.
struct NormalAccuracy {
    double relative_variance = 0.0;   ///< of one sample of f/p, over its mean squared; infinite with a violation
    double irradiance = 0.0;          ///< integral of g max(0, n . omega)
    double share_above_horizon = 0.0; ///< of the samples
    double max_weight = 0.0;          ///< largest f/p over its mean
    std::uint64_t support_violations = 0;      ///< texels with f > 0 and p = 0
    double relative_variance_full_cdf = 0.0;   ///< what the probe's own full-resolution CDF has
    double share_above_horizon_full_cdf = 0.0; ///< the same
    bool combined = false;                     ///< see LocalAccuracy
    double max_weight_full_cdf = 0.0;          ///< beside the partner, where combined
};

using LocalAccuracy = builder::LocalAccuracy;

/// One a normal, of any length > 0; all 0 where a normal sees no light. The file is a local environment without
/// tilted curves, and of the target's resolution (rows theta, columns phi), else std::invalid_argument. The same
/// for any number of threads.
std::vector<NormalAccuracy> measure_normals(const File& file, const compress::Target& target,
                                            const std::vector<Normal>& normals);
LocalAccuracy summary(const std::vector<NormalAccuracy>& normals);

/// `count` random normals, uniform over the sphere; the same ones every time.
std::vector<Normal> random_normals(std::uint32_t count);

/// The normals over which accuracy is measured: random ones or, where a scene is given, of the scene.
std::vector<Normal> test_normals(const std::vector<compress::SceneNormal>& scene, std::uint32_t count);

} // namespace acdf::build
