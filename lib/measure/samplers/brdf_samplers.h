// What renderers commonly sample reflected directions with: baselines.
#pragma once

#include "build/accuracy/brdf.h"

#include <cstddef>
#include <cstdint>
#include <vector>

namespace acdf::measure {

/// A direction of light. Where `wi` is below the horizon the sample counts as 0: `pdf` is 0 then.
struct BrdfSample {
    double wi[3] = {0.0, 0.0, 0.0};
    double pdf = 0.0; ///< sr^-1
};

/// wi proportional to its cosine.
struct CosineSampler {
    static BrdfSample sample(const double wo[3], const double u[2]);
    static double pdf(const double wo[3], const double wi[3]);
    static constexpr std::size_t bytes() { return 0; }
};

/// Reflection at normals of a GGX lobe that are visible from wo (Heitz, "Sampling the GGX Distribution of Visible
/// Normals", JCGT 7(4), 2018): pdf = D(wh) G1(wo) / (4 cos(theta_o)).
class GgxSampler {
public:
    explicit GgxSampler(double alpha) : alpha_x_(alpha), alpha_y_(alpha) {}
    GgxSampler(double alpha_x, double alpha_y) : alpha_x_(alpha_x), alpha_y_(alpha_y) {}

    BrdfSample sample(const double wo[3], const double u[2]) const; ///< u in [0, 1)
    double pdf(const double wo[3], const double wi[3]) const { return pdf(wo, scale(wo), wi); }
    /// What all pdfs of a view are multiplied by; 0 below the surface.
    double scale(const double wo[3]) const;
    /// The same for a view whose scale is known: D(wh) by the half-vector as it is long, |wh|^4 of what the
    /// ellipsoid makes of it, so that there is no root.
    double pdf(const double wo[3], double scale, const double wi[3]) const {
        const double h[3] = {wo[0] + wi[0], wo[1] + wi[1], wo[2] + wi[2]};
        const double x = h[0] / alpha_x_, y = h[1] / alpha_y_;
        const double length2 = h[0] * h[0] + h[1] * h[1] + h[2] * h[2];
        const double part = length2 / (x * x + y * y + h[2] * h[2]);
        return scale > 0.0 && wi[2] > 0.0 ? scale * part * part : 0.0;
    }
    static constexpr std::size_t bytes() { return 2 * sizeof(double); }
    double alpha() const { return alpha_x_; }

private:
    double alpha_x_, alpha_y_;
};

struct GgxFit {
    double alpha = 0.0;
    double relative_variance = 0.0; ///< mean over the views
};

/// The isotropic lobe with the least mean relative variance over `views`: alpha in [0.001, 2], by golden section
/// over its logarithm about the best of thirteen. Sums over `columns` x `rows` half-vectors a view.
GgxFit best_ggx(const compress::Reflected& reflected, const std::vector<compress::View>& views,
                std::uint32_t columns = 64, std::uint32_t rows = 128);

} // namespace acdf::measure
