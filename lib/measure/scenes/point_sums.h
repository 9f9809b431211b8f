// What samplers do at one point of a scene, without the noise of pictures: sums over all texels of the probe, and
// samples that are held to them.
#pragma once

#include "measure/scenes/scene_points.h"

#include <cstdint>
#include <memory>
#include <random>
#include <vector>

namespace acdf::measure {

/// One sampler, or several that are weighted by the balance heuristic. Referred to.
struct SamplerParts {
    struct Part {
        std::vector<const LightSampler*> of_material;
        std::uint32_t samples = 1; ///< of an estimate
    };
    std::vector<Part> parts;
};

/// The parts as one thread uses them, at a point.
class PartsAtPoint {
public:
    PartsAtPoint(const SamplerParts& of, const ScenePoint& point);

    /// The mean pdf of all samples, in sr^-1; `own`: of each part.
    double density(const float direction[3], std::vector<double>& own) const;
    /// Of an estimate.
    std::uint32_t samples() const { return all_; }
    /// An estimate of the integral of f by that many samples. A direction has the f of its texel's middle, so that
    /// its expectation is what is summed, whatever the texels.
    double estimate(const ScenePoint& point, const ProbeLight& light, std::mt19937_64& random) const;

private:
    friend class PointMoments;
    std::vector<std::unique_ptr<PointSampler>> parts_;
    std::vector<std::uint32_t> samples_;
    std::uint32_t all_ = 0;
};

struct PointSums {
    double mean = 0.0; ///< the integral of f, the luminance that is reflected
    /// One each of those measured. Variance: of an estimate of one sample, n have an n-th of it.
    std::vector<double> variance;
    std::vector<std::uint32_t> lost; ///< texels with light that are never sampled
};

/// Each texel counts with f in its middle (a shadow ray) and its solid angle.
PointSums sums_at(const ScenePoint& point, const ProbeLight& light, const std::vector<PartsAtPoint>& samplers);

} // namespace acdf::measure
