// The mappings of each layout: golden directions worked out by hand, agreement with the references, round
// trips, solid angles, and OpenEXR's own functions for its cube.
#include "build/probe/projection.h"
#include "tests/lib/build/probe/projection_reference.h"

#include <OpenEXR/ImfEnvmap.h>
#include <gtest/gtest.h>

#include <random>

namespace {

using namespace acdf::build;
using namespace acdf::test;

struct Case {
    const char* name;
    Map map;
    Reference reference;
};

std::vector<Case> cases() {
    return {{"latlong", {Layout::latlong, 64, 32}, latlong_reference},
            {"angular", {Layout::angular, 50, 50}, angular_reference},
            {"mirrorball", {Layout::mirrorball, 50, 50}, mirrorball_reference},
            {"vertical cross", {Layout::vertical_cross, 48, 64}, vertical_cross_reference()},
            {"horizontal cross", {Layout::horizontal_cross, 64, 48}, horizontal_cross_reference()},
            {"octahedral", {Layout::octahedral, 40, 40}, octahedral_reference}};
}

Direction direction(Vec v) { return {v.x, v.y, v.z}; }
Vec vec(Direction d) { return {d.x, d.y, d.z}; }

void expect_shows(const Map& map, double u, double v, Vec expected, const char* what) {
    Direction d;
    ASSERT_TRUE(to_direction(map, u, v, d)) << what;
    EXPECT_LT(length(vec(d) - normalized(expected)), 1e-9) << what << ": " << d.x << " " << d.y << " " << d.z;
    const ImagePoint p = to_image(map, direction(normalized(expected)));
    EXPECT_NEAR(p.u, u, 1e-7) << what;
    EXPECT_NEAR(p.v, v, 1e-7) << what;
}

// Seen from inside, looking along +x with z up, the left is +y.
TEST(InputProjection, GoldenLatlong) {
    const Map map{Layout::latlong, 8, 4};
    expect_shows(map, 0.5, 0.5, {1, 0, 0}, "centre");
    expect_shows(map, 0.25, 0.5, {0, 1, 0}, "a quarter from the left");
    expect_shows(map, 0.75, 0.5, {0, -1, 0}, "a quarter from the right");
    expect_shows(map, 0.375, 0.25, {0.5, 0.5, std::sqrt(0.5)}, "upper left of the centre");
    expect_shows(map, 0.625, 0.75, {0.5, -0.5, -std::sqrt(0.5)}, "lower right of the centre");
    const ImagePoint seam = to_image(map, {-1.0, 0.0, 0.0});
    EXPECT_TRUE(seam.u == 0.0 || seam.u > 1.0 - 1e-12);
}

TEST(InputProjection, GoldenAngular) {
    const Map map{Layout::angular, 8, 8};
    expect_shows(map, 0.5, 0.5, {1, 0, 0}, "centre");
    expect_shows(map, 0.75, 0.5, {0, 1, 0}, "half way to the right: 90 degrees left, mirrored as in the ball");
    expect_shows(map, 0.5, 0.25, {0, 0, 1}, "half way up: zenith");
    expect_shows(map, 0.375, 0.5, {1, -1, 0}, "a quarter to the left: 45 degrees right");
    expect_shows(map, 0.5, 0.875, {-1, 0, -1}, "three quarters down: 135 degrees, behind and below");
    Direction d;
    EXPECT_FALSE(to_direction(map, 0.01, 0.01, d));
}

TEST(InputProjection, GoldenMirrorball) {
    const Map map{Layout::mirrorball, 8, 8};
    const double r = 0.5 * std::sqrt(0.5); // the normal at 45 degrees reflects by 90
    expect_shows(map, 0.5, 0.5, {1, 0, 0}, "centre: the camera");
    expect_shows(map, 0.5 + r, 0.5, {0, 1, 0}, "right: the photographer's right, +y");
    expect_shows(map, 0.5, 0.5 - r, {0, 0, 1}, "up");
    expect_shows(map, 0.5 - 0.5 * std::sin(pi / 3.0), 0.5, {-0.5, -std::sqrt(0.75), 0},
                 "normal at 60: 120 degrees");
}

TEST(InputProjection, GoldenCrosses) {
    const Map vertical{Layout::vertical_cross, 48, 64}, horizontal{Layout::horizontal_cross, 64, 48};
    for (const auto& [map, columns, rows] : {std::tuple{vertical, 3.0, 4.0}, std::tuple{horizontal, 4.0, 3.0}}) {
        expect_shows(map, 1.5 / columns, 1.5 / rows, {1, 0, 0}, "front");
        expect_shows(map, 1.25 / columns, 1.25 / rows, {1, 0.5, 0.5}, "front, upper left");
        expect_shows(map, 0.5 / columns, 1.5 / rows, {0, 1, 0}, "left");
        expect_shows(map, 0.75 / columns, 1.25 / rows, {0.5, 1, 0.5}, "left, towards the front, up");
        expect_shows(map, 2.25 / columns, 1.75 / rows, {0.5, -1, -0.5}, "right, towards the front, down");
        expect_shows(map, 1.25 / columns, 0.75 / rows, {0.5, 0.5, 1}, "up, left, towards the front");
        expect_shows(map, 1.75 / columns, 2.25 / rows, {0.5, -0.5, -1}, "down, right, towards the front");
        Direction d;
        EXPECT_FALSE(to_direction(map, 0.5 / columns, 0.5 / rows, d)) << "unused";
    }
    expect_shows(vertical, 1.25 / 3.0, 3.25 / 4.0, {-1, 0.5, -0.5}, "back, below its middle: near the down face");
    expect_shows(horizontal, 3.25 / 4.0, 1.25 / 3.0, {-1, -0.5, 0.5}, "back, near the right face, up");
}

TEST(InputProjection, GoldenOctahedral) {
    const Map map{Layout::octahedral, 8, 8};
    expect_shows(map, 0.5, 0.5, {0, 0, 1}, "centre: up");
    expect_shows(map, 0.25, 0.75, {1, 1, 0}, "the diamond's edge is the horizon");
    expect_shows(map, 0.25, 0.5, {std::sqrt(0.4375), 0, 0.75}, "r = 1/2: z = 1 - r^2, towards +x");
    expect_shows(map, 0.5, 0.25, {0, -std::sqrt(0.4375), 0.75}, "r = 1/2 towards -y");
    // |a| = 3/4, |b| = 1/2: r = 1 - 1/4, phi = (1 - 1/3) 45 = 30 degrees, z = -(1 - 9/16), below the horizon.
    const double sine = 0.75 * std::sqrt(2.0 - 0.5625);
    expect_shows(map, 0.125, 0.75, {sine * std::sqrt(0.75), sine * 0.5, -0.4375}, "lower hemisphere");
}

TEST(InputProjection, AgreesWithReferences) {
    std::mt19937 random(7);
    std::uniform_real_distribution<double> uniform;
    for (const Case& c : cases()) {
        int shown = 0;
        for (int i = 0; i < 20000; ++i) {
            const double u = uniform(random), v = uniform(random);
            Direction d;
            Vec expected;
            const bool shows = c.reference(u, v, expected);
            ASSERT_EQ(to_direction(c.map, u, v, d), shows) << c.name << " at " << u << " " << v;
            if (!shows) continue;
            ++shown;
            ASSERT_LT(length(vec(d) - expected), 1e-9) << c.name << " at " << u << " " << v;
        }
        EXPECT_GT(shown, 5000) << c.name;
    }
}

// Both of Debevec's formulas say the same: the references agree with each other and with the library.
TEST(InputProjection, AngularAgreesWithBothPublishedFormulas) {
    std::mt19937 random(13);
    std::uniform_real_distribution<double> uniform;
    for (int i = 0; i < 5000; ++i) {
        const double u = uniform(random), v = uniform(random);
        Vec d;
        if (!angular_reference(u, v, d)) continue;
        double back_u, back_v;
        angular_reference_point(d, back_u, back_v);
        ASSERT_NEAR(back_u, u, 1e-7);
        ASSERT_NEAR(back_v, v, 1e-7);
        const ImagePoint p = to_image({Layout::angular, 2, 2}, direction(d));
        ASSERT_NEAR(p.u, back_u, 1e-7);
        ASSERT_NEAR(p.v, back_v, 1e-7);
    }
}

// Both discs are photographs of a ball: they differ by a radial stretch, nothing is turned or mirrored.
TEST(InputProjection, DiscsShowADirectionOnTheSameSide) {
    std::mt19937 random(19);
    std::normal_distribution<double> normal;
    for (int i = 0; i < 5000; ++i) {
        const Direction d = direction(normalized({normal(random), normal(random), normal(random)}));
        const ImagePoint angular = to_image({Layout::angular, 2, 2}, d),
                         ball = to_image({Layout::mirrorball, 2, 2}, d);
        const double angle = std::atan2(0.5 - angular.v, angular.u - 0.5);
        ASSERT_NEAR(std::remainder(angle - std::atan2(0.5 - ball.v, ball.u - 0.5), 2.0 * pi), 0.0, 1e-9);
    }
}

std::vector<Vec> many_directions() {
    std::mt19937 random(11);
    std::normal_distribution<double> normal;
    std::vector<Vec> all;
    for (int i = 0; i < 20000; ++i) all.push_back(normalized({normal(random), normal(random), normal(random)}));
    for (const double a : {-1.0, 0.0, 1.0}) // axes, edges and corners of the cube, where charts meet
        for (const double b : {-1.0, 0.0, 1.0})
            for (const double c : {-1.0, 0.0, 1.0})
                if (a != 0.0 || b != 0.0 || c != 0.0) all.push_back(normalized({a, b, c}));
    return all;
}

TEST(InputProjection, RoundTrip) {
    std::vector<Case> all = cases();
    all.push_back({"stacked cube", {Layout::stacked_cube, 10, 60}, {}});
    for (const Case& c : all)
        for (const Vec& expected : many_directions()) {
            const ImagePoint p = to_image(c.map, direction(expected));
            ASSERT_TRUE(p.u >= 0.0 && p.u < 1.0 && p.v >= 0.0 && p.v < 1.0) << c.name;
            Direction d;
            // The rim of a disc is one direction, sampled a rounding error inside or outside the disc.
            if (!to_direction(c.map, p.u, p.v, d)) {
                ASSERT_LT(length(expected - Vec{-1, 0, 0}), 1e-6) << c.name;
                continue;
            }
            ASSERT_LT(length(vec(d) - expected), 1e-7)
                << c.name << " " << expected.x << " " << expected.y << " " << expected.z;
        }
}

TEST(InputProjection, SolidAnglesSumToTheSphere) {
    std::vector<Case> all = cases();
    all.push_back({"stacked cube", {Layout::stacked_cube, 10, 60}, {}});
    all.push_back({"tiny angular", {Layout::angular, 3, 3}, {}});
    all.push_back({"single texels", {Layout::stacked_cube, 1, 6}, {}});
    for (const Case& c : all) {
        double sum = 0.0;
        for (int y = 0; y < c.map.height; ++y)
            for (int x = 0; x < c.map.width; ++x) sum += texel_solid_angle(c.map, x, y);
        EXPECT_NEAR(sum / (4.0 * pi), 1.0, c.map.width < 10 ? 1e-3 : 1e-5) << c.name;
    }
}

TEST(InputProjection, SolidAnglesMatchFiniteDifferences) {
    for (const Case& c : cases())
        for (int y = 3; y < c.map.height; y += 7)
            for (int x = 2; x < c.map.width; x += 5) {
                const double a = (2.0 * x + 1.0) / c.map.width - 1.0, b = (2.0 * y + 1.0) / c.map.height - 1.0;
                const bool disc = c.map.layout == Layout::angular || c.map.layout == Layout::mirrorball;
                if (disc && std::abs(std::hypot(a, b) - 1.0) < 0.06) continue; // differences fail across the rim
                const double expected = solid_angle_by_differences(c.reference, c.map.width, c.map.height, x, y, 8);
                EXPECT_NEAR(texel_solid_angle(c.map, x, y), expected, 2e-3 * expected)
                    << c.name << " " << x << " " << y;
            }
}

// ImfEnvmap.h, compiled from OpenEXR itself. Its (X, Y, Z) is our (y, z, x).
TEST(InputProjection, StackedCubeIsOpenExrs) {
    const int n = 16;
    const Map map{Layout::stacked_cube, n, 6 * n};
    const Imath::Box2i window(Imath::V2i(0, 0), Imath::V2i(n - 1, 6 * n - 1));
    std::mt19937 random(3);
    std::normal_distribution<double> normal;
    for (int i = 0; i < 5000; ++i) {
        const Vec d = normalized({normal(random), normal(random), normal(random)});
        const Imath::V3f exr(static_cast<float>(d.y), static_cast<float>(d.z), static_cast<float>(d.x));
        Imf::CubeMapFace face;
        Imath::V2f in_face;
        Imf::CubeMap::faceAndPixelPosition(exr, window, face, in_face);
        const Imath::V2f pixel = Imf::CubeMap::pixelPosition(face, window, in_face);
        const ImagePoint p = to_image(map, direction(d));
        // OpenEXR counts from texel centres.
        ASSERT_NEAR(p.u * n - 0.5, pixel.x, 1e-3) << d.x << " " << d.y << " " << d.z;
        ASSERT_NEAR(p.v * 6 * n - 0.5, pixel.y, 1e-3) << d.x << " " << d.y << " " << d.z;
    }
}

TEST(InputProjection, LatlongWidthIsAPowerOfTwoNoCoarserThanTheSource) {
    EXPECT_EQ(latlong_width({Layout::angular, 1000, 1000}), 1024);
    EXPECT_EQ(latlong_width({Layout::angular, 1024, 1024}), 1024);
    EXPECT_EQ(latlong_width({Layout::angular, 1025, 1025}), 2048);
    EXPECT_EQ(latlong_width({Layout::vertical_cross, 768, 1024}), 1024);
    EXPECT_EQ(latlong_width({Layout::stacked_cube, 256, 1536}), 1024);
    EXPECT_EQ(latlong_width({Layout::mirrorball, 600, 600}), 1024);
    EXPECT_EQ(latlong_width({Layout::octahedral, 512, 512}), 1024);
    EXPECT_EQ(latlong_width({Layout::latlong, 1000, 500}), 1000);
    EXPECT_EQ(latlong_width({Layout::angular, 1, 1}), 4);
}

TEST(InputProjection, OctahedralSideIsNoCoarserThanTheSourceButForMapsOfFewRows) {
    EXPECT_EQ(octahedral_side({Layout::latlong, 1024, 512}), 1024);
    EXPECT_EQ(octahedral_side({Layout::latlong, 4096, 1024}), 4096);
    EXPECT_EQ(octahedral_side({Layout::latlong, 65536, 1}), 1024);
    EXPECT_EQ(octahedral_side({Layout::latlong, 1, 65536}), 4);
    EXPECT_EQ(octahedral_side({Layout::vertical_cross, 768, 1024}), 1024);
}

} // namespace
