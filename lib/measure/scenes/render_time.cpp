#include "measure/scenes/render_time.h"

#include "measure/stopwatch.h"

#include <algorithm>

namespace acdf::measure {
namespace {

constexpr std::size_t kMostPoints = 1024;

/// One estimator at work on the same points over and over, as a renderer's thread is.
class Runner {
public:
    Runner(const std::vector<const ScenePoint*>& points, const std::vector<const Estimator*>& estimators,
           Numbers numbers)
        : points_(points), random_(1, numbers) {
        for (const Estimator* estimator : estimators) own_.push_back(estimator->point_estimator());
    }

    double once() {
        const Stopwatch watch;
        Tally tally;
        for (const ScenePoint* point : points_) {
            const Rgb estimate = own_[point->material()]->estimate(point->shading(), *point, random_, tally);
            sink_ = sink_ + estimate[0];
        }
        return watch.nanoseconds() / static_cast<double>(points_.size());
    }

private:
    const std::vector<const ScenePoint*>& points_;
    std::vector<std::unique_ptr<PointEstimator>> own_;
    Random random_;
    volatile double sink_ = 0.0; ///< results that nobody reads need not be computed
};

} // namespace

std::vector<std::vector<double>> time_estimates(const std::vector<ScenePoint>& points,
                                                const std::vector<std::vector<const Estimator*>>& estimators,
                                                const TimingOptions& options) {
    std::vector<std::vector<double>> out(estimators.size());
    const std::size_t count = std::min<std::size_t>(points.size(), kMostPoints);
    std::vector<const ScenePoint*> chosen;
    for (std::size_t i = 0; i < count; ++i) chosen.push_back(&points[i * points.size() / count]);
    if (chosen.empty()) return out;

    std::vector<Runner> runners;
    std::vector<std::size_t> repeats;
    for (const auto& one : estimators) {
        runners.emplace_back(chosen, one, options.numbers);
        const double first = runners.back().once() * static_cast<double>(count); // warms caches, too
        repeats.push_back(static_cast<std::size_t>(std::clamp(1e9 * options.seconds_a_round / first, 1.0, 1e4)));
    }
    for (std::uint32_t round = 0; round < options.rounds; ++round)
        for (std::size_t e = 0; e < runners.size(); ++e) {
            double sum = 0.0;
            for (std::size_t k = 0; k < repeats[e]; ++k) sum += runners[e].once();
            out[e].push_back(sum / static_cast<double>(repeats[e]));
        }
    return out;
}

} // namespace acdf::measure
