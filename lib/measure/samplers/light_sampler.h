// What all samplers of incident light have in common, ours and their baselines: what renderings and timings
// compare.
#pragma once

#include <acdf/sample.h>

#include <cstddef>
#include <cstdint>
#include <memory>

namespace acdf::measure {

/// Where light is gathered. n and wo are unit directions away from the surface, in the frame of
/// docs/conventions.md.
struct ShadingPoint {
    float n[3] = {0.0f, 0.0f, 1.0f};  ///< normal
    float wo[3] = {0.0f, 0.0f, 1.0f}; ///< towards the viewer
    float position[3] = {};           ///< in the coordinates of the scene's meshes
};

/// A sampler in the hands of one thread: at one shading point at a time.
class PointSampler {
public:
    virtual ~PointSampler() = default;

    /// Does whatever the sampler has to do once for all samples of a point.
    virtual void move_to(const ShadingPoint& point) = 0;
    /// u0, u1 in [0, 1). A pdf of 0: nothing was sampled (the sample counts, as 0). Directions below the horizon
    /// keep their pdf: the integrand is 0 there.
    virtual AcdfDirectionSample sample(double u0, double u1) const = 0;
    /// sr^-1, of `sample` at this point; 0 for directions that it never samples.
    virtual float pdf(const float wi[3]) const = 0;
    /// Which share of the samples to take from it beside others, in (0, 1]; 1 where it does not know.
    virtual float recommended_light_share() const { return 1.0f; }
};

/// What a sampler has to make anew for each picture, beside what it does at its points.
struct Making {
    double seconds = 0.0; ///< of processor time
    std::uint64_t shadow_rays = 0;
};

/// Tables that are built once, for all threads; must outlive the PointSamplers that it makes.
class LightSampler {
public:
    virtual ~LightSampler() = default;

    virtual std::unique_ptr<PointSampler> point_sampler() const = 0;
    /// Memory that sampling reads.
    virtual std::uint64_t bytes() const = 0;
    virtual Making making() const { return {}; }
};

} // namespace acdf::measure
