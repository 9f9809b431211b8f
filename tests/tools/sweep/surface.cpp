// Variances of a diffuse surface: by summation, by sampling, and where light is hidden.
#include "tests/inputs/synthetic.h"

#include "measure/samplers/light_samplers.h"
#include "measure/samplers/local_baselines.h"
#include "tools/render/scene_file.h"
#include "tools/sweep/occluders.h"
#include "tools/sweep/surface.h"
#include "tools/sweep/surface_samples.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <iterator>

namespace acdf::tools {
namespace {

TEST(SweepSurface, AgreesWithTheClosedFormsOfBaselines) {
    const compress::Target target = acdf_test::noise_target(48, 24, 5, 1.0, 0.1);
    const std::vector<build::Normal> normals = build::random_normals(5);
    const measure::LocalFullCdf full(target);
    const auto sampler = measure::full_cdf_sampler(target);
    const std::vector<float> pdf = texel_pdfs(target, *sampler);
    const SurfaceVariances got = summary(point_variances(target, pdf, in_the_open(normals)), Scale::own);
    std::vector<double> each;
    for (const build::Normal& n : normals) each.push_back(full.relative_variance(n.data()));
    const Lit expected = spread_of(each);
    EXPECT_NEAR(got.alone.mean, expected.mean, 1e-5 * expected.mean);
    EXPECT_NEAR(got.alone.median, expected.median, 1e-5 * expected.median);
    EXPECT_NEAR(got.alone.worst, expected.worst, 1e-5 * expected.worst);
    const std::vector<float> nothing(pdf.size(), 0.0f);
    const SurfaceVariances dark = summary(point_variances(target, nothing, in_the_open({normals[0]})), Scale::own);
    EXPECT_TRUE(std::isinf(dark.alone.mean));
    // All that is sampled is the cosine's: half as many samples of it as are counted.
    const double of_cosine = measure::CosineHemisphere(target).relative_variance(normals[0].data());
    EXPECT_NEAR(dark.partner.mean, 2.0 * of_cosine, 1e-9 * of_cosine);
    const Lit even = spread_of({1.0, 2.0, 4.0, 9.0});
    EXPECT_EQ(even.mean, 4.0);
    EXPECT_EQ(even.median, 3.0);
    EXPECT_EQ(even.worst, 9.0);
}

TEST(SweepSurface, WhatIsHiddenDoesNotCount) {
    const compress::Target target = acdf_test::noise_target(48, 24, 5, 1.0, 0.1);
    const auto sampler = measure::full_cdf_sampler(target);
    const std::vector<float> pdf = texel_pdfs(target, *sampler);
    SurfacePoint point;
    const PointVariance open = point_variances(target, pdf, {point}).front();
    point.hidden.assign(pdf.size(), false);
    const PointVariance same = point_variances(target, pdf, {point}).front();
    EXPECT_EQ(open.alone, same.alone);
    EXPECT_EQ(open.partner, same.partner);
    compress::Target dark = target;
    for (std::size_t i = 0; i < dark.values.size(); i += 3) {
        dark.values[i] = 0.0f;
        point.hidden[i] = true;
    }
    const PointVariance hidden = point_variances(target, pdf, {point}).front();
    const PointVariance without = point_variances(dark, pdf, {{}}).front();
    EXPECT_LT(hidden.irradiance, 0.8 * open.irradiance);
    EXPECT_NEAR(hidden.irradiance, without.irradiance, 1e-12 * open.irradiance);
    EXPECT_NEAR(hidden.alone, without.alone, 1e-9 * open.alone);
    EXPECT_NEAR(hidden.partner, without.partner, 1e-9 * open.partner);
    // E^2 + (0.1 mean E)^2: a point without light does not decide.
    const Lit scaled = summary({{1.0, 0.5, 0.5}, {0.0, 0.0, 0.0}}, Scale::picture).alone;
    EXPECT_NEAR(scaled.worst, 0.5 / (1.0 + 0.05 * 0.05), 1e-12);
}

TEST(SweepSurface, TheOccludersAreThoseOfTheDemoScene) {
    std::ifstream file(ACDF_SCENES "/demo-hidden.json");
    const SceneFile scene = parse_scene({std::istreambuf_iterator<char>(file), {}});
    const measure::Geometry geometry = demo_geometry();
    ASSERT_EQ(scene.geometry.objects.size(), geometry.objects.size());
    for (std::size_t i = 0; i < geometry.objects.size(); ++i) {
        const measure::Object &a = scene.geometry.objects[i], &b = geometry.objects[i];
        EXPECT_EQ(a.seen, b.seen);
        ASSERT_EQ(a.shape.index(), b.shape.index());
        if (const auto* plane = std::get_if<measure::Plane>(&a.shape)) {
            EXPECT_EQ(plane->z, std::get<measure::Plane>(b.shape).z);
            EXPECT_EQ(plane->extent, std::get<measure::Plane>(b.shape).extent);
        } else if (const auto* sphere = std::get_if<measure::Sphere>(&a.shape)) {
            EXPECT_EQ(sphere->centre, std::get<measure::Sphere>(b.shape).centre);
            EXPECT_EQ(sphere->radius, std::get<measure::Sphere>(b.shape).radius);
        } else {
            EXPECT_EQ(std::get<measure::Box3>(a.shape).low, std::get<measure::Box3>(b.shape).low);
            EXPECT_EQ(std::get<measure::Box3>(a.shape).high, std::get<measure::Box3>(b.shape).high);
        }
    }
    EXPECT_EQ(scene.camera.from, demo_camera().from);
    EXPECT_EQ(scene.camera.to, demo_camera().to);
    EXPECT_EQ(scene.camera.fov, demo_camera().fov);

    const compress::Target target = acdf_test::noise_target(32, 16, 3);
    const std::vector<SurfacePoint> points = behind_occluders(target, 48);
    std::size_t hidden = 0, shadowed = 0;
    for (const SurfacePoint& point : points) {
        shadowed += !point.hidden.empty();
        hidden += std::size_t(std::count(point.hidden.begin(), point.hidden.end(), true));
    }
    EXPECT_NEAR(double(points.size()), 48.0, 12.0);
    EXPECT_EQ(shadowed, points.size());
    const double share = double(hidden) / double(points.size() * target.values.size() / 2);
    EXPECT_GT(share, 0.15); // of what lies above the horizon
    EXPECT_LT(share, 0.6);
}

// A set of a single point is uniform: then sampled variances are those of the sums.
TEST(SweepSurface, SampledVariancesAreThoseOfTheSums) {
    const compress::Target target = acdf_test::noise_target(48, 24, 5, 1.0, 0.1);
    const auto sampler = measure::full_cdf_sampler(target);
    const std::vector<SurfacePoint> points = behind_occluders(target, 12);
    const auto exact = point_variances(target, texel_pdfs(target, *sampler), points);
    const SurfaceVariances sums = summary(exact, Scale::picture);
    const SampledVariances two =
        sobol_variances(target, measure::MapLight(target), *sampler, points, exact, Scale::picture, 2, 1500);
    // Of two Sobol' points: less than of two independent ones; with an MIS partner a set of one each: exactly
    // those.
    EXPECT_LT(two.alone, sums.alone.mean);
    EXPECT_NEAR(two.partner, sums.partner.mean, 0.1 * sums.partner.mean);
    const SampledVariances many =
        sobol_variances(target, measure::MapLight(target), *sampler, points, exact, Scale::picture, 64, 100);
    EXPECT_LT(many.alone, 0.7 * sums.alone.mean);
    EXPECT_LT(many.partner, 0.7 * sums.partner.mean);
    const SampledVariances again =
        sobol_variances(target, measure::MapLight(target), *sampler, points, exact, Scale::picture, 64, 100);
    EXPECT_EQ(many.alone, again.alone);
    EXPECT_EQ(many.partner, again.partner);
}

} // namespace
} // namespace acdf::tools
