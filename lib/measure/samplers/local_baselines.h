// What one can do today to estimate the irradiance E(n), the integral of f = L max(0, n . omega), from a probe: the
// baselines of a local environment map, each with its exact relative variance.
//
// In all of them the target is a probe, lat-long or octahedral (compress::of_texels; with nearest lookup g is f:
// compress::Target); it is referred to, not copied, and must outlive the sampler. Normals are unit. Directions are
// sampled over whole texels; relative variances take each texel's cosine at its centre (TexelCosines), and are 0
// where E(n) is.
#pragma once

#include "build/accuracy/texel_cosines.h"
#include "compress/target.h"
#include "measure/samplers/full_cdf.h"
#include "measure/samplers/probe_grid.h"

#include <acdf/sample.h>

#include <algorithm>
#include <cstdint>

namespace acdf::measure {

/// The full-resolution CDF of L: samples below the horizon are sampled in vain.
class LocalFullCdf {
public:
    /// Throws std::invalid_argument where the target is no such probe or black.
    explicit LocalFullCdf(const compress::Target& target);

    /// u0 (columns) and u1 (rows) in [0, 1).
    AcdfDirectionSample sample(double u0, double u1) const;
    /// sr^-1; 0 for directions that are NaN or not unit.
    float pdf(const float direction[3]) const;
    /// Of one sample: f/p = F max(0, cos) with F the integral of L, so it is F int L cos^2 / E^2 - 1.
    double relative_variance(const float n[3]) const;
    /// Probability that a sample lies above the horizon of n.
    double share_above_horizon(const float n[3]) const;
    std::uint64_t bytes() const { return cdf_.bytes(); }
    /// The integral of L over the sphere.
    double flux() const { return grid_.flux(); }

private:
    const compress::Target& target_;
    ProbeGrid grid_;
    FullCdf cdf_;
    build::TexelCosines cosines_;
};

/// Resampled importance sampling (Talbot, Cline, Egbert, EGSR 2005): M candidates x_i from the full CDF, one of
/// them kept with probability proportional to w_i = f(x_i)/p(x_i). The pdf of what is kept has no closed form,
/// which is why there is no pdf(): no multiple importance sampling but with further approximations.
class Resampling {
public:
    struct Sample {
        float direction[3];
        double weight; ///< f(direction) * weight is the estimate: an unbiased 1/p, sr; 0 where no candidate is lit
    };

    Resampling(const compress::Target& target, std::uint32_t candidates) : cdf_(target), candidates_(candidates) {}

    /// `uniform()` gives numbers in [0, 1): three for each candidate.
    template <class Uniform>
    Sample sample(const float n[3], Uniform&& uniform) const {
        Sample kept{{0.0f, 0.0f, 1.0f}, 0.0};
        double sum = 0.0, kept_target = 0.0; // of w_i / flux = max(0, cos)
        for (std::uint32_t i = 0; i < candidates_; ++i) {
            const double u0 = uniform(), u1 = uniform(), choice = uniform();
            const AcdfDirectionSample x = cdf_.sample(u0, u1);
            const double cosine =
                double{n[0]} * x.direction[0] + double{n[1]} * x.direction[1] + double{n[2]} * x.direction[2];
            if (!(cosine > 0.0)) continue;
            sum += cosine;
            if (choice * sum >= cosine) continue;
            std::copy_n(x.direction, 3, kept.direction);
            kept_target = double{x.pdf} * cosine; // f / flux
        }
        if (sum > 0.0) kept.weight = sum / candidates_ / kept_target;
        return kept;
    }

    /// The estimate is f(y) (1/M sum of w_i) / f(y): as the resampling target is f itself, f(y) cancels whichever
    /// candidate is kept, and what remains is the mean of M independent f/p: a full CDF's variance over M.
    double relative_variance(const float n[3]) const { return cdf_.relative_variance(n) / candidates_; }
    std::uint64_t bytes() const { return cdf_.bytes(); }

private:
    LocalFullCdf cdf_;
    std::uint32_t candidates_;
};

/// Directions with pdf cos / pi: knows the surface, not the light.
class CosineHemisphere {
public:
    explicit CosineHemisphere(const compress::Target& target) : target_(target), cosines_(target) {}

    /// u0, u1 in [0, 1).
    static AcdfDirectionSample sample(const float n[3], double u0, double u1);
    /// sr^-1; 0 below the horizon.
    static float pdf(const float n[3], const float direction[3]);
    /// Of one sample: f/p = pi L, so it is pi int L^2 cos / E^2 - 1.
    double relative_variance(const float n[3]) const;
    static std::uint64_t bytes() { return 0; }

private:
    const compress::Target& target_;
    build::TexelCosines cosines_;
};

} // namespace acdf::measure
