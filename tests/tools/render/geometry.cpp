// Rays, shadows and the exact sum over texels.
#include "tests/inputs/synthetic.h"

#include "input/brdf/models.h"
#include "measure/scenes/reference.h"
#include "measure/scenes/scene_points.h"
#include "measure/surface_frame.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace acdf::measure {
namespace {

using acdf_test::uniform;

bool contains(const Shape& shape, const Vec3& p) {
    if (const auto* sphere = std::get_if<Sphere>(&shape))
        return dot(p - sphere->centre, p - sphere->centre) <= sphere->radius * sphere->radius;
    if (const auto* box = std::get_if<Box3>(&shape)) {
        for (std::size_t k = 0; k < 3; ++k)
            if (p[k] < box->low[k] || p[k] > box->high[k]) return false;
        return true;
    }
    return p[2] <= std::get<Plane>(shape).z; // the half-space below it
}

Vec3 random_direction(std::mt19937_64& random) {
    const double z = 2.0 * uniform(random) - 1.0, phi = 2.0 * acdf_test::kPi * uniform(random);
    const double r = std::sqrt(1.0 - z * z);
    return {r * std::cos(phi), r * std::sin(phi), z};
}

/// In steps along the ray, where `contains` changes; negative where it never does.
double march(const Shape& shape, const Ray& ray, double step, double end) {
    const bool inside = contains(shape, ray.origin);
    for (double t = step; t < end; t += step)
        if (contains(shape, ray.origin + t * ray.direction) != inside) return t - 0.5 * step;
    return -1.0;
}

TEST(RenderScene, RaysMeetShapesWhereMarchingDoes) {
    const std::vector<Shape> shapes{Sphere{{0.3, -0.2, 0.5}, 1.1}, Box3{{-0.7, -1.2, 0.1}, {0.9, 0.4, 1.6}},
                                    Plane{-0.3, 1e6}};
    constexpr double step = 2e-3, end = 8.0;
    std::mt19937_64 random(3);
    int hits = 0, misses = 0, near_misses = 0;
    for (const Shape& shape : shapes)
        for (int i = 0; i < 150; ++i) {
            const Ray ray{3.0 * uniform(random) * random_direction(random), random_direction(random)};
            const double marched = march(shape, ray, step, end);
            std::optional<Hit> hit = intersect(shape, ray, 0.0);
            if (hit && hit->distance > end - step) hit.reset();
            if (marched < 0.0 && hit) { // a chord too short for the march
                ++near_misses;
                continue;
            }
            ASSERT_EQ(hit.has_value(), marched >= 0.0) << i;
            if (!hit) {
                ++misses;
                continue;
            }
            ++hits;
            EXPECT_NEAR(hit->distance, marched, step) << i;
            EXPECT_LT(dot(hit->n, ray.direction), 0.0);
            EXPECT_NEAR(dot(hit->n, hit->n), 1.0, 1e-12);
            // The normal points to the side that the ray came from.
            const double lift = 1e-6;
            EXPECT_EQ(contains(shape, hit->position + lift * hit->n), contains(shape, ray.origin)) << i;
            EXPECT_NE(contains(shape, hit->position - lift * hit->n), contains(shape, ray.origin)) << i;
        }
    EXPECT_GT(hits, 100);
    EXPECT_GT(misses, 50);
    EXPECT_LT(near_misses, 4);
}

TEST(RenderScene, RaysAlongASideOfABoxAreNotLost) {
    const Box3 box{{0.0, 0.0, 0.0}, {1.0, 1.0, 1.0}};
    const auto hit = intersect(box, {{-1.0, 0.0, 0.5}, {1.0, 0.0, 0.0}}, 0.0); // 0 / 0 in y
    ASSERT_TRUE(hit);
    EXPECT_DOUBLE_EQ(hit->distance, 1.0);
    EXPECT_FALSE(intersect(box, {{-1.0, 2.0, 0.5}, {1.0, 0.0, 0.0}}, 0.0));
}

TEST(RenderScene, CameraSeesUpAboveAndLeftOnTheLeft) {
    Camera camera;
    camera.from = {5.0, 0.0, 0.0}; // looks along -x: +y is to its right
    const Ray corner = camera.ray(0, 0, 9, 9), centre = camera.ray(4, 4, 9, 9);
    EXPECT_GT(corner.direction[2], 0.0);
    EXPECT_LT(corner.direction[1], 0.0);
    EXPECT_NEAR(centre.direction[0], -1.0, 1e-12);
}

TEST(RenderScene, SurfaceFramesAreRightHanded) {
    std::mt19937_64 random(5);
    for (int i = 0; i < 100; ++i) {
        const Vec3 n = i < 2 ? Vec3{0.0, 0.0, i ? -1.0 : 1.0} : random_direction(random);
        Vec3 x, y;
        surface_frame(n.data(), x.data(), y.data());
        const Vec3 z = cross(x, y);
        for (std::size_t k = 0; k < 3; ++k) EXPECT_NEAR(z[k], n[k], 1e-12);
        EXPECT_NEAR(dot(x, x), 1.0, 1e-12);
        EXPECT_NEAR(dot(x, y), 0.0, 1e-12);
    }
}

/// A scene of one colour of light unless `radiance` says otherwise.
struct Lit {
    std::unique_ptr<input::Brdf> brdf;
    std::vector<float> rgb;
    Scene scene;

    Lit(
        const std::string& model, std::vector<Object> objects, std::uint32_t rows = 64,
        const std::function<float(std::uint32_t row)>& radiance = [](std::uint32_t) { return 2.0f; })
        : brdf(input::model_brdf(model)) {
        for (std::uint32_t r = 0; r < rows; ++r) rgb.insert(rgb.end(), 3 * 2 * rows, radiance(r));
        scene.geometry.objects = std::move(objects);
        scene.camera.from = {6.0, 1.0, 1.5};
        scene.width = scene.height = 6;
        scene.materials = {{brdf.get(), {1.0, 1.0, 1.0}}};
        scene.light = {2 * rows, rows, rgb.data()};
    }
};

TEST(RenderReference, OfEvenLightOnALambertianIsItsAlbedo) {
    const Lit lit("lambert:albedo=0.6", {{Sphere{{0.0, 0.0, 0.0}, 1.5}, 0, true}});
    const auto points = visible_points(lit.scene).points;
    ASSERT_GT(points.size(), 6u);
    for (const Rgb& value : reference(lit.scene.light, points))
        for (const double channel : value) EXPECT_NEAR(channel, 1.2, 1e-3);
}

TEST(RenderReference, HalfOfTheSkyBehindAWallIsHalfOfTheLight) {
    // The wall begins a hair beside the points and is, for them, without end.
    const Box3 wall{{-1e5, 0.0, -1.0}, {1e5, 1.0, 1e5}};
    Lit lit("lambert:albedo=1", {{Plane{0.0, 1e6}, 0, true}, {wall, 0, false}}, 256);
    const Ray down{{0.0, -1e-4, 1.0}, {0.0, 0.0, -1.0}};
    const auto hit = lit.scene.geometry.trace(down);
    ASSERT_TRUE(hit);
    const ScenePoint point(lit.scene, down, *hit);
    EXPECT_TRUE(point.shadowed());
    EXPECT_NEAR(point.share_hidden(), 0.5, 1e-12);
    EXPECT_NEAR(reference(lit.scene.light, {point})[0][1], 1.0, 2e-3);
    EXPECT_NEAR(reference(lit.scene.light, {point.in_the_open()})[0][1], 2.0, 2e-3);
}

TEST(RenderReference, LightFromAboveReachesWhatFacesUp) {
    const Lit lit("lambert:albedo=1", {{Box3{{-1.0, -1.0, -1.0}, {1.0, 1.0, 1.0}}, 0, true}}, 64,
                  [](std::uint32_t row) { return row < 32 ? 1.0f : 0.0f; });
    const auto at = [&](const Vec3& from, const Vec3& direction) {
        const Ray ray{from, direction};
        return reference(lit.scene.light, {ScenePoint(lit.scene, ray, *lit.scene.geometry.trace(ray))})[0][0];
    };
    EXPECT_NEAR(at({0.0, 0.0, 3.0}, {0.0, 0.0, -1.0}), 1.0, 1e-3);
    EXPECT_NEAR(at({3.0, 0.0, 0.0}, {-1.0, 0.0, 0.0}), 0.5, 1e-3);
    EXPECT_EQ(at({0.0, 0.0, -3.0}, {0.0, 0.0, 1.0}), 0.0);
}

// A sun of one texel whose centre is behind an edge, though a part of it is not.
TEST(RenderReference, RefinesASunThatIsPartlyHidden) {
    constexpr std::uint32_t rows = 32;
    Lit lit("lambert:albedo=1", {{Plane{0.0, 1e6}, 0, true}, {Box3{{0.0, -1e4, 0.0}, {1e4, 1e4, 1.0}}, 0, false}},
            rows, [](std::uint32_t) { return 1e-6f; });
    const std::uint32_t column = rows, row = 10; // just below phi = 0
    for (std::size_t k = 0; k < 3; ++k) lit.rgb[3 * (row * 2 * rows + column) + k] = 1000.0f;
    // The wall's height above the point is 1: from this far away its edge cuts a texel at z of its upper quarter.
    const double z0 = std::cos(acdf_test::kPi * row / rows), z1 = std::cos(acdf_test::kPi * (row + 1) / rows);
    const double z = z0 + 0.25 * (z1 - z0), distance = std::sqrt(1.0 - z * z) / z;
    const Ray down{{-distance, 0.0, 1.0}, {0.0, 0.0, -1.0}};
    const ScenePoint point(lit.scene, down, *lit.scene.geometry.trace(down));
    const double open = reference(lit.scene.light, {point.in_the_open()})[0][0];
    EXPECT_NEAR(reference(lit.scene.light, {point})[0][0] / open, 0.25, 0.1);
}

} // namespace
} // namespace acdf::measure
