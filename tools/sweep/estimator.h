// A path tracer's estimate of direct light, and its variance: by samples of the light alone, and by one sample of
// the light and one of the BSDF.
#pragma once

#include "compress/target.h"
#include "measure/map_lookup.h"
#include "measure/samplers/light_sampler.h"
#include "measure/scenes/scene_points.h"
#include "tools/sweep/sweep.h"

#include <array>
#include <cstdint>
#include <functional>
#include <vector>

namespace acdf::tools {

/// The width of the glossy lobe: GGX, samples of visible normals.
constexpr double kGlossyAlpha = 0.2;

/// Where light is gathered, seen at 45 degrees.
struct SurfacePoint {
    measure::ShadingPoint shading;
    std::function<bool(const float wi[3])>
        hidden; ///< in the cases with something hidden; called by several threads
};

/// Random normals, the same ones every time, each beside a wall that hides half of its sky.
std::vector<SurfacePoint> half_hidden_points(std::uint32_t count);
/// Points of a mesh with what it hides; `points` must outlive them.
std::vector<SurfacePoint> mesh_points(const std::vector<measure::ScenePoint>& points);

/// Of one point in one case: what it reflects, and the variance of one sample. Infinite: light is never sampled.
struct PointVariance {
    double reflected = 0.0;
    std::array<double, kEstimators> variance{};
};
using PointVariances = std::array<PointVariance, kCases>;

struct SamplerAtPoints {
    const measure::LightSampler* sampler = nullptr;
    Given needs = Given::nothing; ///< nothing: its pdf is the same at all points
};

/// The pdf of a sampler that is the same at all points, in the middle of each texel (its z halves the texel's solid
/// angle).
std::vector<float> texel_pdfs(const compress::Target& target, const measure::LightSampler& sampler);

/// By summation over texels, with directions in the middle of each; what is looked up has the target's mean and
/// mean square over a texel. A vector a sampler, of all points. The same for any number of threads.
std::vector<std::vector<PointVariances>> point_variances(const compress::Target& target,
                                                         const std::vector<SamplerAtPoints>& samplers,
                                                         const std::vector<SurfacePoint>& points,
                                                         AcdfHeuristic heuristic);

/// The same of scrambled Sobol' points, by taking `samples` (rounded up to an even number) of them in each of
/// `seeds` (at least 2) estimates: the variance of an estimate times its samples. With MIS half of them are the
/// BSDF's. `exact`, of the same points, has what they reflect; `light` is what samples find.
std::vector<PointVariances> sobol_variances(const measure::MapLight& light, const measure::LightSampler& sampler,
                                            const std::vector<SurfacePoint>& points,
                                            const std::vector<PointVariances>& exact, AcdfHeuristic heuristic,
                                            std::uint32_t samples, std::uint32_t seeds);

/// In each case that of a picture: the mean of variances over points, over the square of what points reflect on
/// average.
std::array<std::array<double, kCases>, kEstimators> relative_variances(const std::vector<PointVariances>& points);

} // namespace acdf::tools
