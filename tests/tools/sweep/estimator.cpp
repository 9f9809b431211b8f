// Variances of a path tracer's estimate: by summation, by sampling, and where light is hidden.
#include "tests/inputs/nearest_lookup.h"
#include "tests/inputs/synthetic.h"

#include "build/accuracy/local.h"
#include "build/own_terms.h"
#include "measure/samplers/light_samplers.h"
#include "measure/samplers/local_baselines.h"
#include "tools/sweep/build.h"
#include "tools/sweep/estimator.h"
#include "tools/sweep/files.h"

#include <gtest/gtest.h>

#include <cmath>

namespace acdf::tools {
namespace {

compress::Target probe() { return acdf_test::noise_target(96, 48, 5, 1.0, 0.1); }

std::vector<PointVariances> sums(const compress::Target& target, const measure::LightSampler& sampler,
                                 const std::vector<SurfacePoint>& points, Given needs = Given::nothing,
                                 AcdfHeuristic heuristic = ACDF_HEURISTIC_BALANCE) {
    return point_variances(target, {{&sampler, needs}}, points, heuristic).front();
}

double own_relative(const PointVariance& point, Estimator estimator) {
    return point.variance[estimator] / (point.reflected * point.reflected);
}

TEST(SweepEstimator, AgreesWithTheClosedFormsOfBaselines) {
    const compress::Target target = probe();
    const auto cdf = measure::full_cdf_sampler(target), cosine = measure::cosine_sampler();
    const std::vector<SurfacePoint> points = half_hidden_points(5);
    const measure::LocalFullCdf full(target);
    const measure::CosineHemisphere hemisphere(target);
    const auto of_cdf = sums(target, *cdf, points), of_cosine = sums(target, *cosine, points, Given::normal);
    for (std::size_t i = 0; i < points.size(); ++i) {
        const double expected = full.relative_variance(points[i].shading.n);
        EXPECT_NEAR(own_relative(of_cdf[i][diffuse_open], light_alone), expected, 1e-5 * expected);
        const double of_surface = hemisphere.relative_variance(points[i].shading.n);
        EXPECT_NEAR(own_relative(of_cosine[i][diffuse_open], light_alone), of_surface, 1e-5 * of_surface);
        // Two samples of one pdf are as good as any two.
        EXPECT_NEAR(own_relative(of_cosine[i][diffuse_open], with_mis), of_surface, 1e-5 * of_surface);
    }
}

TEST(SweepEstimator, LocalFilesHaveTheVarianceThatTheyStore) {
    const compress::Target target = acdf_test::noise_target(256, 128, 5); // measure_normals divides smaller maps
    const Candidate file = make_file({"local", 32768}, builder::target_of(target, acdf::test::nearest_lookup()), {},
                                     nullptr, ACDF_HEURISTIC_BALANCE);
    const std::vector<SurfacePoint> points = half_hidden_points(6);
    std::vector<build::Normal> normals;
    for (const SurfacePoint& point : points)
        normals.push_back({point.shading.n[0], point.shading.n[1], point.shading.n[2]});
    const auto stored = build::measure_normals(file.file->file, target, normals);
    const auto found = sums(target, *file.sampler, points, Given::normal);
    for (std::size_t i = 0; i < points.size(); ++i)
        EXPECT_NEAR(own_relative(found[i][diffuse_open], light_alone), stored[i].relative_variance,
                    1e-3 * stored[i].relative_variance + 1e-5);
}

TEST(SweepEstimator, WhatIsHiddenIsBlack) {
    const compress::Target target = probe();
    std::vector<SurfacePoint> points = half_hidden_points(3);
    for (SurfacePoint& point : points) point.hidden = [](const float wi[3]) { return wi[0] > 0.0f; };
    const auto sampler = measure::full_cdf_sampler(target);
    const auto found = sums(target, *sampler, points);
    // The same light with those texels black, and the same pdf of the whole.
    compress::Target dark = target;
    for (std::size_t i = 0; i < dark.values.size(); ++i) // the middle of the map is +x
        if (i % target.columns >= target.columns / 4 && i % target.columns < 3 * target.columns / 4)
            dark.values[i] = 0.0f;
    const auto expected = sums(dark, *sampler, points);
    for (std::size_t i = 0; i < points.size(); ++i)
        for (const auto& [hidden, open] : {std::pair{diffuse_hidden, diffuse_open}, {glossy_hidden, glossy_open}}) {
            EXPECT_LT(found[i][hidden].reflected, found[i][open].reflected);
            EXPECT_NEAR(found[i][hidden].reflected, expected[i][open].reflected, 1e-9);
            for (const Estimator e : {light_alone, with_mis})
                EXPECT_NEAR(found[i][hidden].variance[e], expected[i][open].variance[e],
                            1e-9 * expected[i][open].variance[e]);
        }
}

TEST(SweepEstimator, AWallHidesHalfOfTheSky) {
    const compress::Target even =
        acdf_test::texel_target(128, 64, [](std::uint32_t, std::uint32_t) { return 1.0; });
    const auto sampler = measure::full_cdf_sampler(even);
    for (const PointVariances& point : sums(even, *sampler, half_hidden_points(8))) {
        EXPECT_NEAR(point[diffuse_open].reflected, 1.0, 0.01);
        EXPECT_NEAR(point[diffuse_hidden].reflected, 0.5, 0.02);
        EXPECT_LT(point[glossy_open].reflected, 1.0); // what the lobe's masking leaves
        EXPECT_GT(point[glossy_open].reflected, 0.8);
    }
}

TEST(SweepEstimator, LightThatIsNeverSampledIsABias) {
    const compress::Target target = probe();
    const auto compensated = measure::compensated_sampler(target);
    for (const PointVariances& point : sums(target, *compensated, half_hidden_points(3)))
        for (const PointVariance& one : point) {
            EXPECT_TRUE(std::isinf(one.variance[light_alone]));
            EXPECT_TRUE(std::isfinite(one.variance[with_mis]));
        }
}

// A set of a single point is uniform: then sampled variances are those that sums have.
TEST(SweepEstimator, SampledVariancesAreThoseOfTheSums) {
    const compress::Target target = probe();
    const auto sampler = measure::full_cdf_sampler(target);
    const std::vector<SurfacePoint> points = half_hidden_points(12);
    for (const AcdfHeuristic heuristic : {ACDF_HEURISTIC_BALANCE, ACDF_HEURISTIC_POWER}) {
        const auto exact = sums(target, *sampler, points, Given::nothing, heuristic);
        const auto expected = relative_variances(exact);
        const auto sampled = [&](std::uint32_t samples, std::uint32_t seeds) {
            return relative_variances(
                sobol_variances(measure::MapLight(target), *sampler, points, exact, heuristic, samples, seeds));
        };
        const auto two = sampled(2, 4000), many = sampled(64, 100);
        for (std::size_t c = 0; c < kCases; ++c) {
            // One of the light and one of the BSDF: exactly those; two of the light: less than of independent ones.
            EXPECT_NEAR(two[with_mis][c], expected[with_mis][c], 0.06 * expected[with_mis][c]) << c;
            EXPECT_LT(two[light_alone][c], expected[light_alone][c]) << c;
            EXPECT_LT(many[light_alone][c], two[light_alone][c]) << c;
            EXPECT_LT(many[with_mis][c], two[with_mis][c]) << c;
        }
        EXPECT_EQ(many, sampled(64, 100));
    }
}

TEST(SweepEstimator, NoiseIsThatOfAPicture) {
    std::vector<PointVariances> points(2);
    points[0][diffuse_open] = {3.0, {0.5, 0.25}};
    points[1][diffuse_open] = {1.0, {0.7, 0.0}};
    const auto relative = relative_variances(points);
    EXPECT_NEAR(relative[light_alone][diffuse_open], 0.6 / 4.0, 1e-12);
    EXPECT_NEAR(relative[with_mis][diffuse_open], 0.125 / 4.0, 1e-12);
    EXPECT_EQ(relative[with_mis][glossy_open], 0.0); // black
}

} // namespace
} // namespace acdf::tools
