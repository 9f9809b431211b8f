// The equal-area octahedral square against pbrt-v4's published functions, and against what a map of equal areas is.
#include "tests/inputs/directions.h"

#include <acdf/octahedral.h>

#include <gtest/gtest.h>

#include <algorithm>

namespace {

using acdf_test::kPi, acdf_test::uniform;

/// EqualAreaSquareToSphere of pbrt-v4, src/pbrt/util/math.cpp, in double precision: its frame is ours with x
/// reversed.
void pbrt_direction(double px, double py, double w[3]) {
    const double u = 2 * px - 1, v = 2 * py - 1, up = std::abs(u), vp = std::abs(v);
    const double signed_distance = 1 - (up + vp), d = std::abs(signed_distance), r = 1 - d;
    const double phi = (r == 0 ? 1 : (vp - up) / r + 1) * kPi / 4;
    const double z = std::copysign(1 - r * r, signed_distance);
    const double cos_phi = std::copysign(std::cos(phi), u), sin_phi = std::copysign(std::sin(phi), v);
    w[0] = -cos_phi * r * std::sqrt(2 - r * r);
    w[1] = sin_phi * r * std::sqrt(2 - r * r);
    w[2] = z;
}

/// EqualAreaSphereToSquare of pbrt-v4, with the library's atan in the place of its polynomial.
void pbrt_point(const double w[3], double& px, double& py) {
    const double x = std::abs(w[0]), y = std::abs(w[1]), z = std::abs(w[2]);
    const double r = std::sqrt(std::max(0.0, 1 - z)), a = std::max(x, y), b = a == 0 ? 0 : std::min(x, y) / a;
    double phi = std::atan(b) * 2 / kPi;
    if (x < y) phi = 1 - phi;
    double v = phi * r, u = r - v;
    if (w[2] < 0) {
        std::swap(u, v);
        u = 1 - u;
        v = 1 - v;
    }
    px = 0.5 * (std::copysign(u, -w[0]) + 1);
    py = 0.5 * (std::copysign(v, w[1]) + 1);
}

TEST(Octahedral, isTheMapOfPbrt) {
    std::mt19937_64 random(1);
    for (int n = 0; n < 200000; ++n) {
        const double u = uniform(random), v = uniform(random);
        double d[3], expected[3], at[2], expected_at[2];
        acdf_octahedral_direction(u, v, d);
        pbrt_direction(u, v, expected);
        for (int i = 0; i < 3; ++i) ASSERT_NEAR(d[i], expected[i], 4e-15) << u << ' ' << v;
        acdf_octahedral_point(d, &at[0], &at[1]);
        pbrt_point(d, expected_at[0], expected_at[1]);
        ASSERT_NEAR(at[0], expected_at[0], 1e-7)
            << u << ' ' << v; // pbrt's sqrt(1 - z) has half the digits at poles
        ASSERT_NEAR(at[1], expected_at[1], 1e-7) << u << ' ' << v;
        ASSERT_NEAR(at[0], u, 4e-15);
        ASSERT_NEAR(at[1], v, 4e-15);
    }
}

TEST(Octahedral, hasItsPolesAxesAndEquator) {
    const double at[][5] = {{0.5, 0.5, 0, 0, 1}, {0, 0, 0, 0, -1},
                            {1, 0, 0, 0, -1},    {0, 1, 0, 0, -1},
                            {1, 1, 0, 0, -1},    {0, 0.5, 1, 0, 0},
                            {1, 0.5, -1, 0, 0},  {0.5, 0, 0, -1, 0},
                            {0.5, 1, 0, 1, 0},   {0.25, 0.75, M_SQRT1_2, M_SQRT1_2, 0}};
    for (const auto& c : at) {
        double d[3], u, v;
        acdf_octahedral_direction(c[0], c[1], d);
        for (int i = 0; i < 3; ++i) EXPECT_NEAR(d[i], c[2 + i], 1e-15) << c[0] << ' ' << c[1];
        acdf_octahedral_point(c + 2, &u, &v);
        if (c[4] == -1) continue; // any corner
        EXPECT_NEAR(u, c[0], 1e-15);
        EXPECT_NEAR(v, c[1], 1e-15);
    }
}

// Both halves of a side show the same directions.
TEST(Octahedral, foldsItsSides) {
    for (int i = 0; i <= 100; ++i) {
        const double t = i / 100.0;
        for (const double side : {0.0, 1.0}) {
            double a[3], b[3];
            acdf_octahedral_direction(t, side, a);
            acdf_octahedral_direction(1 - t, side, b);
            for (int k = 0; k < 3; ++k) EXPECT_NEAR(a[k], b[k], 1e-15) << t;
            acdf_octahedral_direction(side, t, a);
            acdf_octahedral_direction(side, 1 - t, b);
            for (int k = 0; k < 3; ++k) EXPECT_NEAR(a[k], b[k], 1e-15) << t;
        }
    }
}

// The Jacobian, by differences, is 4 pi everywhere; speeds are within the bounds that readers and fits rely on.
TEST(Octahedral, preservesArea) {
    constexpr double h = 1e-7;
    std::mt19937_64 random(2);
    double least = 1e9, most = 0.0;
    for (int n = 0; n < 200000; ++n) {
        double at[2] = {uniform(random), uniform(random)};
        if (n % 2 == 0) at[0] = 0.5 + 2e-4 * (at[0] - 0.5); // near the poles and the lines where it bends
        if (n % 4 == 0) at[1] = 0.5 + 2e-4 * (at[1] - 0.5);
        // Within one of the eight triangles.
        const double a = std::abs(2 * at[0] - 1), b = std::abs(2 * at[1] - 1);
        if (a < 4 * h || b < 4 * h || a > 1 - 4 * h || b > 1 - 4 * h || std::abs(a + b - 1) < 8 * h) continue;
        if (1 - std::abs(a + b - 1) < 500 * h) continue; // so near to a pole that differences are none
        double u0[3], u1[3], v0[3], v1[3], du[3], dv[3];
        acdf_octahedral_direction(at[0] - h, at[1], u0);
        acdf_octahedral_direction(at[0] + h, at[1], u1);
        acdf_octahedral_direction(at[0], at[1] - h, v0);
        acdf_octahedral_direction(at[0], at[1] + h, v1);
        double uu = 0, vv = 0, uv = 0;
        for (int i = 0; i < 3; ++i) {
            du[i] = (u1[i] - u0[i]) / (2 * h);
            dv[i] = (v1[i] - v0[i]) / (2 * h);
            uu += du[i] * du[i];
            vv += dv[i] * dv[i];
            uv += du[i] * dv[i];
        }
        const double area = std::sqrt(uu * vv - uv * uv);
        ASSERT_NEAR(area, 4 * kPi, 2e-3) << at[0] << ' ' << at[1];
        most = std::max({most, std::sqrt(uu), std::sqrt(vv)});
        least = std::min({least, area / std::sqrt(uu), area / std::sqrt(vv)});
    }
    EXPECT_LE(most, ACDF_OCTAHEDRAL_SPEED * 1.0005);
    EXPECT_GE(most, ACDF_OCTAHEDRAL_SPEED * 0.99);
    EXPECT_GE(least, ACDF_OCTAHEDRAL_LEAST_SPEED * 0.9995);
    EXPECT_LE(least, ACDF_OCTAHEDRAL_LEAST_SPEED * 1.01);
}

} // namespace
