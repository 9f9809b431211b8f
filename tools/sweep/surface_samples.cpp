#include "tools/sweep/surface_samples.h"

#include "compress/parallel.h"
#include "measure/random.h"
#include "measure/samplers/local_baselines.h"
#include "measure/samplers/probe_grid.h"
#include "tools/sweep/pixel_samples.h"

#include <algorithm>

namespace acdf::tools {
namespace {

using measure::CosineHemisphere;

/// Light times cosine, 0 where the texel of wi is hidden.
double lit_texel(const compress::Target& target, const measure::MapLight& light, const measure::ProbeGrid& grid,
                 const SurfacePoint& point, const float wi[3]) {
    const build::Normal& n = point.n;
    const double cosine = double{n[0]} * wi[0] + double{n[1]} * wi[1] + double{n[2]} * wi[2];
    std::uint32_t texel[2];
    if (!(cosine > 0.0) || !grid.find(wi, texel)) return 0.0;
    const std::size_t at = std::size_t{texel[1]} * target.columns + texel[0];
    return point.hidden.empty() || !point.hidden[at] ? light.radiance(wi) * cosine : 0.0;
}

measure::ShadingPoint shading_of(const SurfacePoint& point) {
    measure::ShadingPoint out;
    std::copy_n(point.n.begin(), 3, out.n);
    return out;
}

/// Estimates of the irradiance of one point.
class Draws {
public:
    Draws(const compress::Target& target, const measure::MapLight& light, const measure::ProbeGrid& grid,
          measure::PointSampler& sampler, const SurfacePoint& point)
        : target_(target), light_(light), grid_(grid), sampler_(sampler), point_(point) {
        sampler_.move_to(shading_of(point));
    }

    double alone(measure::Random& random, std::uint32_t samples) const {
        return sampled_mean(sampler_, random, samples, [this](const float wi[3]) { return integrand(wi); });
    }
    double partner(measure::Random& random, std::uint32_t samples) {
        double sum = 0.0;
        random.begin_set();
        for (std::uint32_t i = 0; i < samples / 2; ++i) {
            const AcdfDirectionSample s = sampled(random);
            if (s.pdf > 0.0f)
                sum +=
                    integrand(s.direction) / (double{s.pdf} + CosineHemisphere::pdf(point_.n.data(), s.direction));
        }
        random.begin_set();
        for (std::uint32_t i = 0; i < samples / 2; ++i) {
            const std::array<double, 2> u = random.pair();
            const AcdfDirectionSample s = CosineHemisphere::sample(point_.n.data(), u[0], u[1]);
            sum += integrand(s.direction) / (double{s.pdf} + sampler_.pdf(s.direction));
        }
        return sum / (samples / 2);
    }

private:
    AcdfDirectionSample sampled(measure::Random& random) const {
        const std::array<double, 2> u = random.pair();
        return sampler_.sample(u[0], u[1]);
    }
    double integrand(const float wi[3]) const { return lit_texel(target_, light_, grid_, point_, wi); }

    const compress::Target& target_;
    const measure::MapLight& light_;
    const measure::ProbeGrid& grid_;
    measure::PointSampler& sampler_;
    const SurfacePoint& point_;
};

} // namespace

SampledVariances sobol_variances(const compress::Target& target, const measure::MapLight& light,
                                 const measure::LightSampler& sampler, const std::vector<SurfacePoint>& points,
                                 const std::vector<PointVariance>& exact, Scale scale, std::uint32_t samples,
                                 std::uint32_t seeds) {
    samples += samples % 2;
    const measure::ProbeGrid grid(target);
    std::vector<PointVariance> sampled(points.size());
    compress::parallel_for(std::size_t{0}, points.size(), [&](std::size_t i) {
        const std::unique_ptr<measure::PointSampler> own = sampler.point_sampler();
        Draws draws(target, light, grid, *own, points[i]);
        measure::Random random(i, measure::Numbers::sobol);
        std::vector<double> alone, partner;
        for (std::uint32_t seed = 0; seed < seeds; ++seed) {
            alone.push_back(draws.alone(random, samples));
            partner.push_back(draws.partner(random, samples));
        }
        sampled[i] = {exact[i].irradiance, unbiased_variance(alone) * samples,
                      unbiased_variance(partner) * samples};
    });
    const SurfaceVariances out = summary(sampled, scale);
    return {out.alone.mean, out.partner.mean};
}

double sobol_variance(const compress::Target& target, const measure::MapLight& light,
                      const measure::LightSampler& sampler, const std::vector<SurfacePoint>& points,
                      const std::vector<double>& irradiances, std::uint32_t samples, std::uint32_t seeds) {
    const measure::ProbeGrid grid(target);
    std::vector<SampledPoint> sampled;
    for (std::size_t i = 0; i < points.size(); ++i) sampled.push_back({shading_of(points[i]), irradiances[i]});
    return sobol_variance(
        sampler, sampled,
        [&](std::size_t i, const float wi[3]) { return lit_texel(target, light, grid, points[i], wi); }, samples,
        seeds);
}

} // namespace acdf::tools
