// Variances, ratios and their noise, against what is known of them; the same pictures for any number of threads.
#include "tests/inputs/synthetic.h"

#include "input/brdf/models.h"
#include "measure/ratio.h"
#include "measure/samplers/estimators.h"
#include "measure/samplers/light_samplers.h"
#include "measure/scenes/render.h"
#include "measure/scenes/render_time.h"

#include <gtest/gtest.h>
#include <tbb/task_arena.h>

#include <cmath>
#include <numeric>
#include <random>

namespace acdf::measure {
namespace {

/// 3 u: mean 1.5, variance 9 / 12, whatever the point; half of its "samples" are above the horizon.
class Uniform : public Estimator {
public:
    std::unique_ptr<PointEstimator> point_estimator() const override { return std::make_unique<Point>(); }
    std::uint64_t bytes() const override { return 0; }

private:
    struct Point : PointEstimator {
        Rgb estimate(const ShadingPoint&, const Integrand&, Random& random, Tally& tally) override {
            tally.samples += 2;
            tally.above += 1;
            tally.shadow_rays += 3;
            const double value = 3.0 * uniform(random);
            return {value, value, value};
        }
    };
};

struct Ball {
    std::unique_ptr<input::Brdf> brdf = input::model_brdf("lambert:albedo=0.5");
    std::vector<float> rgb = std::vector<float>(std::size_t{3} * 16 * 8, 1.0f);
    Scene scene;
    std::vector<ScenePoint> points;

    Ball() {
        for (std::size_t i = 0; i < 30; ++i) rgb[3 * i] = 5.0f;
        scene.geometry.objects = {{Sphere{{0.0, 0.0, 0.0}, 2.0}, 0, true}};
        scene.width = scene.height = 12;
        scene.materials = {{brdf.get(), {1.0, 1.0, 1.0}}};
        scene.light = {16, 8, rgb.data()};
        points = visible_points(scene).points;
    }
};

TEST(RenderStatistics, EstimateTheVarianceOfAnEstimateWithoutBias) {
    const Ball ball;
    const Uniform estimator;
    RenderOptions options;
    options.seeds = 40;
    const Rendering r = render(ball.points, {&estimator}, "uniform", options);
    const auto points = static_cast<double>(ball.points.size());
    double variance = 0.0, mean = 0.0;
    for (std::size_t i = 0; i < ball.points.size(); ++i) {
        variance += r.variance[i] / points;
        mean += r.mean[i][1] / points;
        EXPECT_EQ(r.share_above[i], 0.5);
    }
    const double estimates = 40.0 * points;
    EXPECT_NEAR(mean, 1.5, 4.0 * std::sqrt(0.75 / estimates));
    // The fourth moment of 3u about its mean is 81 / 80.
    EXPECT_NEAR(variance, 0.75, 4.0 * std::sqrt((81.0 / 80.0 - 0.5625) / estimates));
    EXPECT_EQ(r.tally.samples, 2 * 40 * ball.points.size());
    EXPECT_EQ(r.tally.shadow_rays, 3 * 40 * ball.points.size());

    const std::vector<double> noise = r.noise(std::vector<double>(ball.points.size(), 2.0));
    ASSERT_EQ(noise.size(), 40u);
    double sum = 0.0;
    for (const double seed : noise) sum += seed / 40.0;
    EXPECT_NEAR(sum, variance / 2.0, 1e-12); // the mean over seeds is exactly that of the pictures
}

TEST(RenderStatistics, PicturesAreTheSameForAnyNumberOfThreadsAndDifferByNameAndSeed) {
    const Ball ball;
    const LightSamplerPtr cosine = cosine_sampler();
    const SingleEstimator estimator(*cosine, 3);
    const auto picture = [&](int threads, const char* name, std::uint64_t seed) {
        Rendering out;
        tbb::task_arena arena(threads);
        RenderOptions options;
        options.seeds = 3;
        options.seed = seed;
        arena.execute([&] { out = render(ball.points, {&estimator}, name, options); });
        return out;
    };
    const Rendering one = picture(1, "cosine", 1);
    for (const int threads : {2, 7}) {
        const Rendering other = picture(threads, "cosine", 1);
        EXPECT_EQ(other.first, one.first);
        EXPECT_EQ(other.mean, one.mean);
        EXPECT_EQ(other.deviation_square, one.deviation_square);
    }
    EXPECT_NE(picture(1, "cosine", 2).first, one.first);
    EXPECT_NE(picture(1, "other", 1).first, one.first);
}

TEST(RenderStatistics, NoiseScaleKeepsBlackPixelsFromDeciding) {
    const std::vector<double> scale = noise_scale({{2.0, 2.0, 2.0}, {0.0, 0.0, 0.0}});
    EXPECT_NEAR(scale[0], 4.01, 1e-12); // mean luminance 1
    EXPECT_NEAR(scale[1], 0.01, 1e-12);
}

TEST(RenderStatistics, StudentsQuantiles) {
    EXPECT_NEAR(student_t(1), 12.706, 1e-3);
    EXPECT_NEAR(student_t(6), 2.447, 3e-3);
    EXPECT_NEAR(student_t(15), 2.131, 1e-3);
    EXPECT_NEAR(student_t(1000), 1.962, 1e-3);
}

/// Of exponential numbers of mean 1.
std::vector<double> measured(std::mt19937_64& random, double mean, std::size_t count) {
    std::vector<double> out;
    for (std::size_t i = 0; i < count; ++i) {
        double sum = 0.0;
        for (int k = 0; k < 10; ++k) sum -= 0.1 * mean * std::log(1.0 - acdf_test::uniform(random));
        out.push_back(sum);
    }
    return out;
}

TEST(RenderStatistics, RatiosLieInTheirIntervalsAsOftenAsPromised) {
    std::mt19937_64 random(9);
    constexpr int trials = 2000;
    int ratio = 0, mean = 0, both = 0;
    for (int i = 0; i < trials; ++i) {
        const auto a = measured(random, 6.0, 16), b = measured(random, 2.0, 16);
        const Interval r = ratio_interval(a, b), m = mean_interval(a);
        ratio += r.low <= 3.0 && 3.0 <= r.high;
        mean += m.low <= 6.0 && 6.0 <= m.high;
        const Interval p = product(r, ratio_interval(measured(random, 1.0, 16), measured(random, 2.0, 16)));
        both += p.low <= 1.5 && 1.5 <= p.high;
        EXPECT_GT(r.value, r.low);
    }
    EXPECT_NEAR(mean / double{trials}, 0.95, 0.02);
    EXPECT_NEAR(ratio / double{trials}, 0.955, 0.02); // Student's t of the fewer degrees errs to the safe side
    EXPECT_NEAR(both / double{trials}, 0.955, 0.02);
}

// Estimates of noise by seeds differ as independent figures do, few as they may be.
TEST(RenderStatistics, NoiseOfSeedsDiffersAsMuchAsItsMean) {
    constexpr std::size_t points = 40, trials = 4000;
    std::mt19937_64 random(8);
    std::normal_distribution<double> estimate;
    for (const std::size_t seeds : {3u, 5u}) {
        double told = 0.0, sum = 0.0, square = 0.0;
        for (std::size_t t = 0; t < trials; ++t) {
            Rendering made;
            made.deviation_square.resize(seeds * points);
            for (std::size_t i = 0; i < points; ++i) {
                std::vector<double> x(seeds);
                for (double& value : x) value = estimate(random);
                const double mean = std::accumulate(x.begin(), x.end(), 0.0) / double(seeds);
                for (std::size_t s = 0; s < seeds; ++s)
                    made.deviation_square[s * points + i] =
                        (x[s] - mean) * (x[s] - mean) * double(seeds) / (double(seeds) - 1.0);
            }
            const std::vector<double> noise = made.noise(std::vector<double>(points, 1.0));
            const double mean = std::accumulate(noise.begin(), noise.end(), 0.0) / double(seeds);
            for (const double value : noise)
                told += (value - mean) * (value - mean) / (double(seeds) - 1.0) / double(seeds) / trials;
            sum += mean / trials;
            square += mean * mean / trials;
        }
        EXPECT_NEAR(sum, 1.0, 0.01);
        EXPECT_NEAR(told, square - sum * sum, 0.1 * told) << seeds;
    }
}

TEST(RenderStatistics, RatiosToNothingAreUnknown) {
    const Interval r = ratio_interval({1.0, 1.0}, {0.0, 0.0});
    EXPECT_EQ(r.low, 0.0);
    EXPECT_TRUE(std::isinf(r.high));
}

TEST(RenderStatistics, EachEstimatorIsTimedInEachRound) {
    const Ball ball;
    const Uniform estimator;
    TimingOptions options;
    options.rounds = 3;
    options.seconds_a_round = 1e-4;
    const auto times = time_estimates(ball.points, {{&estimator}, {&estimator}}, options);
    ASSERT_EQ(times.size(), 2u);
    for (const auto& rounds : times) {
        ASSERT_EQ(rounds.size(), 3u);
        for (const double time : rounds) EXPECT_GT(time, 0.0);
    }
}

} // namespace
} // namespace acdf::measure
