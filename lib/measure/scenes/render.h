// Direct lighting of visible points by one estimator: pictures, and how noisy they are.
#pragma once

#include "measure/scenes/scene_points.h"

#include <functional>
#include <string>
#include <vector>

namespace acdf::measure {

struct RenderOptions {
    std::uint32_t seeds = 16; ///< independent pictures, at least 2
    std::uint64_t seed = 1;
    Numbers numbers = Numbers::independent;
};

/// What the variance of a pixel is divided by: L^2 + (0.1 mean L)^2, L the pixel's luminance. The second term keeps
/// a few nearly black pixels from deciding; it is that of relative mean squared error as it is commonly used.
std::vector<double> noise_scale(const std::vector<Rgb>& picture);

/// Of one estimator, over points.
struct Rendering {
    std::vector<Rgb> first;               ///< the picture of the first seed: what a user would see
    std::vector<Rgb> mean;                ///< over seeds
    std::vector<double> variance;         ///< of the luminance of one estimate, without bias
    std::vector<double> share_above;      ///< of samples, above the horizon
    std::vector<double> deviation_square; ///< seeds x points: (luminance - mean)^2 seeds / (seeds - 1)
    Tally tally;                          ///< of all points and seeds

    /// Mean relative variance as each seed estimates it, `scale` as noise_scale gives it; the mean over seeds is
    /// that of the pictures, and their spread that of independent ones. Of three seeds at least.
    std::vector<double> noise(const std::vector<double>& scale) const;
};

/// `estimators`: one a material of the scene. Random numbers depend on the seed, `name` and the point alone: the
/// result is the same for any number of threads, and whatever else is rendered. Uses all cores.
Rendering render(const std::vector<ScenePoint>& points, const std::vector<const Estimator*>& estimators,
                 const std::string& name, const RenderOptions& options,
                 const std::function<void(double)>& progress = {});

} // namespace acdf::measure
