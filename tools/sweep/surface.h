// Exact variances of what a diffuse surface reflects, from a pdf that is known at every texel: used alone and
// combined with the surface's own samples, in the open and behind occluders.
#pragma once

#include "build/accuracy/local.h"
#include "compress/target.h"
#include "measure/samplers/light_sampler.h"
#include "tools/sweep/sweep.h"

#include <array>
#include <cstdint>
#include <functional>
#include <vector>

namespace acdf::tools {

/// The direction of the middle of a texel.
std::array<float, 3> texel_middle(const compress::Target& target, std::uint32_t row, std::uint32_t column);

/// The pdf of a sampler that is not given the normal, in sr^-1, in the middle of each texel (its z halves the
/// texel's solid angle).
std::vector<float> texel_pdfs(const compress::Target& target, const measure::LightSampler& sampler);

/// Where light is gathered: a unit normal, and what is hidden from there.
struct SurfacePoint {
    build::Normal n{0.0f, 0.0f, 1.0f};
    std::vector<bool> hidden; ///< one a texel, row-major; empty: nothing is
};

/// Points of a target's map without occluders.
std::vector<SurfacePoint> in_the_open(const std::vector<build::Normal>& normals);

/// The irradiance E is the integral of f = L max(0, n . omega) visibility. Variances are those of one sample; n
/// have an n-th of it. Infinite where there is light and the pdf is 0.
struct PointVariance {
    double irradiance = 0.0;
    double alone = 0.0;   ///< of f/p
    double partner = 0.0; ///< half of the samples taken by p, half by the cosine, weighted by the balance heuristic
};

/// By summation over texels with each one's cosine in its middle. L^2 is the target's mean square over a texel. The
/// same for any number of threads.
std::vector<PointVariance> point_variances(const compress::Target& target, const std::vector<float>& pdf,
                                           const std::vector<SurfacePoint>& points);

/// What each point's variance is divided by. In the open its own E^2; where something is in the way
/// E^2 + (0.1 mean E)^2, as of pixels (measure::noise_scale), so that a few nearly black ones do not decide.
enum class Scale { own, picture };

/// Relative variances over points that see any light, alone and with an MIS partner.
struct SurfaceVariances {
    Lit alone, partner;
};
SurfaceVariances summary(const std::vector<PointVariance>& points, Scale scale);

/// Mean, median and worst of what `variance` gives for each normal, which several threads ask at once.
Lit over_normals(const std::vector<build::Normal>& normals,
                 const std::function<double(const float n[3])>& variance);

/// Mean, median and worst.
Lit spread_of(std::vector<double> variances);

} // namespace acdf::tools
