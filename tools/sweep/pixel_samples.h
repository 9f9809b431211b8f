// Variances of pixels where a renderer's numbers are not independent: by sampling samples.
#pragma once

#include "measure/random.h"
#include "measure/samplers/light_sampler.h"

#include <cstddef>
#include <cstdint>
#include <functional>
#include <vector>

namespace acdf::tools {

/// Where samples are taken, and the integral of what is reflected there, by summation; 0: nothing is.
struct SampledPoint {
    measure::ShadingPoint shading;
    double integral = 0.0;
};

/// What a point, by its number, reflects of the light from wi. Called by several threads at once.
using SampledIntegrand = std::function<double(std::size_t point, const float wi[3])>;

/// The mean of f/p over a new set of `samples`.
double sampled_mean(const measure::PointSampler& sampler, measure::Random& random, std::uint32_t samples,
                    const std::function<double(const float wi[3])>& integrand);

/// Without bias, of at least two numbers.
double unbiased_variance(const std::vector<double>& values);

/// The variance of an estimate of `samples` scrambled Sobol' points times their number, over the squared integral:
/// the mean over points, where those without light count as 0. It is estimated from `seeds` (at least 2) estimates.
/// With independent numbers it is the relative variance of one sample. The same for any number of threads.
double sobol_variance(const measure::LightSampler& sampler, const std::vector<SampledPoint>& points,
                      const SampledIntegrand& integrand, std::uint32_t samples, std::uint32_t seeds);

} // namespace acdf::tools
