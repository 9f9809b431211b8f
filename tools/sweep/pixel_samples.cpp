#include "tools/sweep/pixel_samples.h"
#include "compress/parallel.h"

#include <memory>

namespace acdf::tools {

double sampled_mean(const measure::PointSampler& sampler, measure::Random& random, std::uint32_t samples,
                    const std::function<double(const float wi[3])>& integrand) {
    random.begin_set();
    double sum = 0.0;
    for (std::uint32_t i = 0; i < samples; ++i) {
        const std::array<double, 2> u = random.pair();
        const AcdfDirectionSample s = sampler.sample(u[0], u[1]);
        if (s.pdf > 0.0f) sum += integrand(s.direction) / double{s.pdf};
    }
    return sum / samples;
}

double unbiased_variance(const std::vector<double>& values) {
    const double n = static_cast<double>(values.size());
    double mean = 0.0, square = 0.0;
    for (const double v : values) mean += v / n;
    for (const double v : values) square += (v - mean) * (v - mean);
    return square / (n - 1.0);
}

double sobol_variance(const measure::LightSampler& sampler, const std::vector<SampledPoint>& points,
                      const SampledIntegrand& integrand, std::uint32_t samples, std::uint32_t seeds) {
    std::vector<double> relative(points.size(), 0.0);
    compress::parallel_for(std::size_t{0}, points.size(), [&](std::size_t i) {
        const double integral = points[i].integral;
        if (!(integral > 0.0)) return;
        const std::unique_ptr<measure::PointSampler> own = sampler.point_sampler();
        own->move_to(points[i].shading);
        measure::Random random(i, measure::Numbers::sobol);
        std::vector<double> estimates(seeds);
        for (double& estimate : estimates)
            estimate =
                sampled_mean(*own, random, samples, [&](const float wi[3]) { return integrand(i, wi); }) / integral;
        relative[i] = unbiased_variance(estimates) * samples;
    });
    double mean = 0.0;
    for (const double v : relative) mean += v / static_cast<double>(relative.size());
    return mean;
}

} // namespace acdf::tools
