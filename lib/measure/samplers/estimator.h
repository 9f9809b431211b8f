// Estimators of the light that a point reflects: what is done with samplers, of one kind or of several.
#pragma once

#include "measure/random.h"
#include "measure/samplers/light_sampler.h"

#include <array>
#include <cstdint>
#include <memory>

namespace acdf::measure {

using Rgb = std::array<double, 3>;

/// What is integrated over the sphere at a shading point: radiance * visibility * BRDF * cosine.
class Integrand {
public:
    virtual ~Integrand() = default;
    virtual Rgb operator()(const float wi[3]) const = 0;
    /// The luminance of the same without visibility, as cheap as it can be had: what resampling weighs candidates
    /// by.
    virtual double unoccluded(const float wi[3]) const = 0;
};

/// What one estimate of a pixel used.
struct Tally {
    std::uint64_t samples = 0;     ///< sampled, also those in vain
    std::uint64_t above = 0;       ///< of them above the horizon of the point's normal
    std::uint64_t shadow_rays = 0; ///< evaluations of the integrand, visibility included
};

class PointEstimator {
public:
    virtual ~PointEstimator() = default;
    /// An unbiased estimate of the integral at `point`; adds to `tally`.
    virtual Rgb estimate(const ShadingPoint& point, const Integrand& f, Random& random, Tally& tally) = 0;
};

/// Its samplers must outlive it, and it the PointEstimators that it makes, one a thread.
class Estimator {
public:
    virtual ~Estimator() = default;
    virtual std::unique_ptr<PointEstimator> point_estimator() const = 0;
    virtual std::uint64_t bytes() const = 0;
};

} // namespace acdf::measure
