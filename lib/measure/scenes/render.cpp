#include "measure/scenes/render.h"

#include "compress/parallel.h"
#include "compress/sum.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <numeric>

namespace acdf::measure {
namespace {

std::uint64_t hash(const std::string& name) { // FNV-1a
    std::uint64_t h = 0xCBF29CE484222325u;
    for (const char c : name) h = (h ^ static_cast<unsigned char>(c)) * 0x100000001B3u;
    return h;
}

/// Everything of one point.
class PointRendering {
public:
    PointRendering(Rendering& out, std::size_t points, const RenderOptions& options, std::uint64_t stream)
        : out_(out), points_(points), options_(options), stream_(stream) {}

    Tally operator()(std::size_t i, const ScenePoint& point, PointEstimator& estimator) const {
        Random random(mixed(mixed(stream_ ^ options_.seed) + i), options_.numbers);
        Tally tally;
        Rgb sum{};
        double luminances = 0.0;
        for (std::uint32_t s = 0; s < options_.seeds; ++s) {
            const Rgb estimate = estimator.estimate(point.shading(), point, random, tally);
            if (s == 0) out_.first[i] = estimate;
            for (std::size_t k = 0; k < 3; ++k) sum[k] += estimate[k];
            out_.deviation_square[s * points_ + i] = luminance(estimate);
            luminances += luminance(estimate);
        }
        const double count = options_.seeds;
        for (std::size_t k = 0; k < 3; ++k) out_.mean[i][k] = sum[k] / count;
        double square = 0.0;
        for (std::uint32_t s = 0; s < options_.seeds; ++s) {
            double& value = out_.deviation_square[s * points_ + i];
            value = (value - luminances / count) * (value - luminances / count) * count / (count - 1.0);
            square += value / count;
        }
        out_.variance[i] = square;
        out_.share_above[i] =
            tally.samples ? static_cast<double>(tally.above) / static_cast<double>(tally.samples) : 0.0;
        return tally;
    }

private:
    Rendering& out_;
    std::size_t points_;
    const RenderOptions& options_;
    std::uint64_t stream_;
};

using PointEstimators = std::vector<std::unique_ptr<PointEstimator>>;

PointEstimators point_estimators(const std::vector<const Estimator*>& estimators) {
    PointEstimators out;
    for (const Estimator* estimator : estimators) out.push_back(estimator->point_estimator());
    return out;
}

} // namespace

std::vector<double> noise_scale(const std::vector<Rgb>& picture) {
    compress::Sum sum;
    for (const Rgb& c : picture) sum.add(luminance(c));
    const double floor = picture.empty() ? 0.0 : 0.1 * sum.value() / static_cast<double>(picture.size());
    std::vector<double> out;
    for (const Rgb& c : picture) out.push_back(luminance(c) * luminance(c) + floor * floor);
    return out;
}

std::vector<double> Rendering::noise(const std::vector<double>& scale) const {
    std::vector<double> out;
    for (std::size_t begin = 0; begin < deviation_square.size(); begin += scale.size()) {
        compress::Sum sum;
        for (std::size_t i = 0; i < scale.size(); ++i)
            if (scale[i] > 0.0) sum.add(deviation_square[begin + i] / scale[i]);
        out.push_back(sum.value() / static_cast<double>(scale.size()));
    }
    // Deviations from a mean that they made themselves differ less than independent ones: of two seeds they are
    // equal. Those of normal estimates have (seeds - 2) / (seeds - 1) of the variance.
    const double seeds = static_cast<double>(out.size()),
                 mean = std::accumulate(out.begin(), out.end(), 0.0) / seeds;
    for (double& of_seed : out)
        of_seed = std::max(0.0, mean + (of_seed - mean) * std::sqrt((seeds - 1.0) / (seeds - 2.0)));
    return out;
}

Rendering render(const std::vector<ScenePoint>& points, const std::vector<const Estimator*>& estimators,
                 const std::string& name, const RenderOptions& options,
                 const std::function<void(double)>& progress) {
    Rendering out;
    out.first.resize(points.size());
    out.mean.resize(points.size());
    out.variance.resize(points.size());
    out.share_above.resize(points.size());
    out.deviation_square.resize(points.size() * options.seeds);
    const PointRendering render_point(out, points.size(), options, mixed(hash(name)));
    std::vector<Tally> tallies(points.size());
    std::atomic<std::size_t> done{0};
    compress::parallel_parts(0, points.size(), 16, [&](std::size_t first, std::size_t last) {
        const PointEstimators own = point_estimators(estimators);
        for (std::size_t i = first; i < last; ++i)
            tallies[i] = render_point(i, points[i], *own[points[i].material()]);
        if (progress) progress(static_cast<double>(done += last - first) / static_cast<double>(points.size()));
    });
    for (const Tally& tally : tallies) {
        out.tally.samples += tally.samples;
        out.tally.above += tally.above;
        out.tally.shadow_rays += tally.shadow_rays;
    }
    return out;
}

} // namespace acdf::measure
