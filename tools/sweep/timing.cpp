#include "tools/sweep/timing.h"

#include <acdf/local.h>

#include <algorithm>
#include <cmath>
#include <random>

#include <time.h>

namespace acdf::tools {
namespace {

using measure::PointSampler;
using measure::ShadingPoint;

constexpr std::size_t kBlock = 256; ///< points of a block, which is what a clock is read around

/// Random numbers and directions, the same for all samplers.
struct Inputs {
    std::vector<double> u;            ///< pairs, kSamplesAPoint a point
    std::vector<float> wi;            ///< triples: cosine distributed around the point's normal
    std::vector<ShadingPoint> points; ///< kBlock a round at most, in turn
};

Inputs make_inputs(const std::vector<ShadingPoint>& points) {
    Inputs in;
    in.points = points;
    std::mt19937_64 random(20050629);
    const auto uniform = [&] { return static_cast<double>(random() >> 11) * 0x1p-53; };
    for (const ShadingPoint& point : points)
        for (std::uint32_t k = 0; k < kSamplesAPoint; ++k) {
            const double u0 = uniform(), u1 = uniform();
            float wi[3];
            acdf_cosine_direction(point.n, uniform(), uniform(), wi);
            in.u.insert(in.u.end(), {u0, u1});
            in.wi.insert(in.wi.end(), wi, wi + 3);
        }
    return in;
}

/// Time of this thread's own, in ns: it stands while another program has the core.
double thread_time() {
    timespec now{};
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
    return 1e9 * static_cast<double>(now.tv_sec) + static_cast<double>(now.tv_nsec);
}

volatile float sink; // what is computed must not be optimised away

/// Works on a block of points, and returns the time of a sample, in ns.
template <class Work>
double timed_block(const Inputs& in, std::size_t begin, PointSampler& sampler, const Work& work) {
    const std::size_t count = std::min(kBlock, in.points.size());
    float sum = 0.0f;
    const double start = thread_time();
    for (std::size_t i = 0; i < count; ++i) {
        const std::size_t at = (begin + i) % in.points.size();
        sampler.move_to(in.points[at]);
        for (std::size_t k = 0; k < kSamplesAPoint; ++k) sum += work(at * kSamplesAPoint + k);
    }
    const double taken = thread_time() - start;
    sink = sum;
    return taken / static_cast<double>(count * kSamplesAPoint);
}

/// Of a block, after another one: a renderer samples with one sampler all the time, and here the one before it has
/// just filled the caches.
template <class Work>
double nanoseconds_each(const Inputs& in, std::size_t begin, PointSampler& sampler, const Work& work) {
    timed_block(in, begin + kBlock, sampler, work);
    return timed_block(in, begin, sampler, work);
}

} // namespace

Interval median_interval(std::vector<double> values) {
    if (values.empty()) return {};
    std::sort(values.begin(), values.end());
    const std::size_t n = values.size();
    const double median = 0.5 * (values[(n - 1) / 2] + values[n / 2]);
    // The largest k with P(fewer than k + 1 of n values are below the median) <= 2.5 %, for either side.
    double term = std::pow(0.5, static_cast<double>(n)), below = 0.0;
    std::size_t k = 0;
    while (k < (n - 1) / 2 && below + term <= 0.025) {
        below += term;
        term *= static_cast<double>(n - k) / static_cast<double>(k + 1);
        ++k;
    }
    const std::size_t outside = k > 0 ? k - 1 : 0;
    return {median, values[outside], values[n - 1 - outside]};
}

Interval ratio_interval(const std::vector<double>& a, const std::vector<double>& b) {
    std::vector<double> ratios;
    for (std::size_t i = 0; i < std::min(a.size(), b.size()); ++i) ratios.push_back(a[i] / b[i]);
    return median_interval(std::move(ratios));
}

std::vector<SweepTimes> time_samplers(const std::vector<const measure::LightSampler*>& samplers,
                                      const std::vector<ShadingPoint>& points, std::uint32_t rounds,
                                      const build::Progress& progress) {
    const Inputs in = make_inputs(points);
    std::vector<std::unique_ptr<PointSampler>> each;
    for (const measure::LightSampler* sampler : samplers) each.push_back(sampler->point_sampler());
    std::vector<SweepTimes> out(samplers.size());
    for (std::uint32_t round = 0; round <= rounds; ++round) {
        const std::size_t begin = round * kBlock % in.points.size();
        for (std::size_t i = 0; i < samplers.size(); ++i) {
            const std::size_t s = (i * (round % 2 ? 1 : samplers.size() - 1) + round) % samplers.size();
            PointSampler& sampler = *each[s];
            const double sample = nanoseconds_each(in, begin, sampler, [&](std::size_t at) {
                return sampler.sample(in.u[2 * at], in.u[2 * at + 1]).pdf;
            });
            if (round > 0) out[s].sample.push_back(sample);
            const double pdf = nanoseconds_each(in, begin, sampler,
                                                [&](std::size_t at) { return sampler.pdf(in.wi.data() + 3 * at); });
            if (round > 0) out[s].pdf.push_back(pdf);
        }
        if (progress) progress((round + 1.0) / (rounds + 1.0), "timing");
    }
    return out;
}

} // namespace acdf::tools
