#include "measure/samplers/local_baselines.h"

#include "compress/sum.h"

#include <algorithm>
#include <cmath>

namespace acdf::measure {
namespace {

using compress::Sum;
using compress::Target;

/// Integrals over the hemisphere above n; L of the target: g, but for the irradiance, which is that of f.
struct Hemisphere {
    double flux = 0.0;             ///< of L
    double irradiance = 0.0;       ///< of L cos, of several channels the root of the sum of their squares
    double radiance_cosine2 = 0.0; ///< of L cos^2
    double radiance2_cosine = 0.0; ///< of L^2 cos

    double relative_to_square(double second_moment) const {
        return irradiance > 0.0 ? std::max(0.0, second_moment / (irradiance * irradiance) - 1.0) : 0.0;
    }
};

Hemisphere hemisphere(const Target& target, const build::TexelCosines& cosines, const float n[3]) {
    Sum flux, radiance_cosine2, radiance2_cosine, irradiance[3];
    for (std::uint32_t r = 0; r < target.rows; ++r) {
        const float* row = target.row(r);
        double sum[3] = {}, lit_means[3] = {};
        cosines.for_each_above(n, r, [&](std::uint32_t c, double cosine) {
            const double radiance = row[c], lit = radiance * target.column_measure[c];
            double means[3];
            const std::size_t channels = compress::means_of(target, std::size_t{r} * target.columns + c, means);
            for (std::size_t k = 0; k < channels; ++k) lit_means[k] += means[k] * target.column_measure[c] * cosine;
            sum[0] += lit;
            sum[1] += lit * cosine * cosine;
            sum[2] += lit * radiance * cosine;
        });
        flux.add(sum[0] * target.row_measure[r]);
        radiance_cosine2.add(sum[1] * target.row_measure[r]);
        radiance2_cosine.add(sum[2] * target.row_measure[r]);
        for (std::size_t k = 0; k < 3; ++k) irradiance[k].add(lit_means[k] * target.row_measure[r]);
    }
    return {flux.value(), std::hypot(irradiance[0].value(), irradiance[1].value(), irradiance[2].value()),
            radiance_cosine2.value(), radiance2_cosine.value()};
}

} // namespace

LocalFullCdf::LocalFullCdf(const Target& target) : target_(target), grid_(target), cdf_(target), cosines_(target) {}

AcdfDirectionSample LocalFullCdf::sample(double u0, double u1) const {
    return grid_.place(cdf_.sample(static_cast<float>(u0), static_cast<float>(u1)));
}

float LocalFullCdf::pdf(const float direction[3]) const {
    std::uint32_t texel[2];
    return grid_.find(direction, texel) ? static_cast<float>(cdf_.pdf(texel[0], texel[1])) : 0.0f;
}

double LocalFullCdf::relative_variance(const float n[3]) const {
    const Hemisphere above = hemisphere(target_, cosines_, n);
    return above.relative_to_square(flux() * above.radiance_cosine2);
}

double LocalFullCdf::share_above_horizon(const float n[3]) const {
    return hemisphere(target_, cosines_, n).flux / flux();
}

AcdfDirectionSample CosineHemisphere::sample(const float n[3], double u0, double u1) {
    const double cosine = std::sqrt(1.0 - u1), radius = std::sqrt(u1); // u1 < 1: never on the horizon
    double sine_phi, cosine_phi;
    acdf_sincospi(2.0 * u0, &sine_phi, &cosine_phi);
    // Two vectors at right angles to n: Duff et al., "Building an Orthonormal Basis, Revisited", JCGT 6(1), 2017.
    const double x = n[0], y = n[1], z = n[2], sign = std::copysign(1.0, z);
    const double a = -1.0 / (sign + z), b = x * y * a;
    const double s = radius * cosine_phi, t = radius * sine_phi;
    AcdfDirectionSample out;
    out.direction[0] = static_cast<float>(s * (1.0 + sign * x * x * a) + t * b + cosine * x);
    out.direction[1] = static_cast<float>(s * sign * b + t * (sign + y * y * a) + cosine * y);
    out.direction[2] = static_cast<float>(-s * sign * x - t * y + cosine * z);
    out.pdf = static_cast<float>(cosine / ACDF_PI);
    return out;
}

float CosineHemisphere::pdf(const float n[3], const float direction[3]) {
    const double cosine = double{n[0]} * direction[0] + double{n[1]} * direction[1] + double{n[2]} * direction[2];
    return cosine > 0.0 ? static_cast<float>(cosine / ACDF_PI) : 0.0f;
}

double CosineHemisphere::relative_variance(const float n[3]) const {
    const Hemisphere above = hemisphere(target_, cosines_, n);
    return above.relative_to_square(ACDF_PI * above.radiance2_cosine);
}

} // namespace acdf::measure
