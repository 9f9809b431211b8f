// Bright tiles at the horizon of normals, normals on the seams of their bins, and hemispheres without any light.
#include "tests/extremes/targets.h"
#include "tests/inputs/local_maps.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>

namespace {

using namespace acdf_test;
using acdf::compress::Target;

constexpr std::uint32_t kColumns = 128, kRows = 64;

/// A lamp of one texel at azimuth 0 with its middle `above` the plane z = 0, in texels; nothing else.
Target lamp(int above) {
    return lit_texel(kColumns, kRows, kColumns / 2, static_cast<std::uint32_t>(static_cast<int>(kRows) / 2 - above),
                     100.0, 0.0);
}

LocalMap map_of(Target target, std::uint32_t subdivisions, bool sharing, AcdfCodec codec = ACDF_CODEC_ZLIB) {
    LocalFileOptions options;
    options.size = {60, 1500};
    options.sharing = sharing;
    options.codec = codec;
    return LocalMap(std::move(target), acdf::compress::octahedral_bins(subdivisions), options);
}

/// Whether any part of the lamp's texel is above the horizon of n, by its corners and edges.
double most_cosine(const Target& target, const float n[3]) {
    double most = -1.0;
    for (std::uint32_t r = 0; r < target.rows; ++r)
        for (std::uint32_t c = 0; c < target.columns; ++c) {
            if (!(target.row(r)[c] > 0.0f)) continue;
            for (int i = 0; i <= 8; ++i)
                for (int j = 0; j <= 8; ++j) {
                    float d[3];
                    direction_of(kPi - 2.0 * kPi * (c + i / 8.0) / target.columns,
                                 std::cos(kPi * (r + j / 8.0) / target.rows), d);
                    most = std::max(most, dot(n, d));
                }
        }
    return most;
}

// Just below (0: its upper edge touches the plane), and just above it: no light that a normal sees goes without.
TEST(ExtremeLocal, LampsAtTheHorizonAreCovered) {
    for (const int above : {0, 1, 2})
        for (const bool sharing : {true, false}) {
            const LocalMap map = map_of(lamp(above), 4, sharing);
            const auto view = map.view();
            // Normals around those for which the lamp is exactly at the horizon.
            for (const double tilt : {-0.06, -0.02, -1e-3, -1e-6, 0.0, 1e-6, 1e-3, 0.02, 0.06}) {
                const float n[3] = {static_cast<float>(std::sin(tilt)), 0.0f, static_cast<float>(std::cos(tilt))};
                for (std::uint32_t i = 0; i < 81; ++i) {
                    const std::uint32_t c = kColumns / 2, r = kRows / 2 - static_cast<std::uint32_t>(above);
                    float d[3];
                    direction_of(kPi - 2.0 * kPi * (c + (i % 9 + 0.5) / 9.0) / kColumns,
                                 std::cos(kPi * (r + (i / 9 + 0.5) / 9.0) / kRows), d);
                    if (dot(n, d) > 0.0) {
                        EXPECT_GT(view.pdf(n, d), 0.0f) << above << " " << tilt << " " << i;
                    }
                }
                const acdf::DirectionSample s = view.sample(n, 0.4, 0.6);
                EXPECT_TRUE(std::isfinite(s.pdf));
                if (most_cosine(map.target, n) > 0.0) {
                    EXPECT_GT(s.pdf, 0.0f);
                }
                if (s.pdf > 0.0f) {
                    EXPECT_EQ(s.pdf, view.pdf(n, s.direction));
                }
            }
        }
}

// Texels as wide as a hemisphere: normals see a part of a lamp whose middle is below the horizon of all of their
// bin.
TEST(ExtremeLocal, TexelsOfCoarseMapsAreCovered) {
    std::mt19937_64 random(17);
    for (const auto& [columns, rows] : {std::array{1u, 1u}, {2u, 1u}, {1u, 2u}, {8u, 2u}, {8u, 4u}, {16u, 8u}})
        for (const bool sharing : {true, false}) {
            const std::uint32_t column = columns / 3, row = rows / 3;
            const LocalMap map = map_of(lit_texel(columns, rows, column, row, 1.0, 0.0), 3, sharing);
            const auto view = map.view();
            for (int i = 0; i < 300; ++i) {
                const Normal n = random_direction(random);
                bool lit = false;
                for (std::uint32_t k = 0; k < 81; ++k) {
                    float d[3];
                    direction_of(kPi - 2.0 * kPi * (column + (k % 9 + 0.5) / 9.0) / columns,
                                 std::cos(kPi * (row + (k / 9 + 0.5) / 9.0) / rows), d);
                    if (dot(n.data(), d) <= 0.0) continue;
                    lit = true;
                    EXPECT_GT(view.pdf(n.data(), d), 0.0f) << columns << " x " << rows << " " << i << " " << k;
                }
                if (lit) {
                    EXPECT_GT(view.sample(n.data(), 0.3, 0.6).pdf, 0.0f) << columns << " x " << rows << " " << i;
                }
            }
        }
}

// Nothing can be sampled where nothing shines: pdf 0, and a sample that says so, whatever the numbers.
TEST(ExtremeLocal, DarkHemispheresSampleNothing) {
    const Target nadir =
        texel_target(kColumns, kRows, [](std::uint32_t, std::uint32_t r) { return r == kRows - 1; });
    for (const bool sharing : {true, false}) {
        const LocalMap map = map_of(nadir, 6, sharing);
        const auto view = map.view();
        const float up[3] = {0.0f, 0.0f, 1.0f}, nearly_up[3] = {0.1f, -0.05f, 0.99f}, down[3] = {0.0f, 0.0f, -1.0f};
        for (const float* n : {up, nearly_up}) {
            for (const double u : {0.0, 0.3, 1.0, std::nan("")}) {
                const acdf::DirectionSample s = view.sample(n, u, 1.0 - u);
                EXPECT_EQ(s.pdf, 0.0f);
                for (const float x : s.direction) EXPECT_TRUE(std::isfinite(x));
            }
            EXPECT_EQ(view.pdf(n, down), 0.0f);
            EXPECT_EQ(view.pdf(n, up), 0.0f);
            EXPECT_EQ(view.irradiance(n), 0.0);
        }
        EXPECT_GT(view.sample(down, 0.5, 0.5).pdf, 0.0f);
        EXPECT_GT(view.pdf(down, down), 0.0f);
        EXPECT_GT(view.irradiance(down), 0.0);
    }
}

/// What a mixture adds up of a direction: its pdf times the light that the normal gets.
double lit(const acdf::LocalEnvironmentView& view, const Normal& normal, const Normal& direction) {
    return static_cast<double>(view.pdf(normal.data(), direction.data())) * view.irradiance(normal.data());
}

/// The largest of that for normals at most about a bin away: that of some corner of `normal`.
double largest_lit(const acdf::LocalEnvironmentView& view, const Normal& normal, const Normal& direction) {
    double most = 0.0;
    for (const float x : {-0.25f, 0.0f, 0.25f})
        for (const float y : {-0.25f, 0.0f, 0.25f})
            for (const float z : {-0.25f, 0.0f, 0.25f})
                most = std::max(most, lit(view, {normal[0] + x, normal[1] + y, normal[2] + z}, direction));
    return most;
}

// On the seams of the octahedron, where a normal's corners change: on both sides the pdf is nearly the same,
// but for what a corner gives whose weight begins there; and it covers and sums to one.
TEST(ExtremeLocal, SeamsOfTheOctahedronAreContinuous) {
    const LocalMap map = map_of(suns_target(kColumns, kRows), 5, true);
    const auto view = map.view();
    std::mt19937_64 random(3);
    for (const Normal& seam : {Normal{0, 0.6f, 0.8f}, Normal{0.6f, 0, -0.8f}, Normal{-0.6f, 0.8f, 0},
                               Normal{0, 0, 1}, Normal{0, -1, 0}, Normal{-1, 0, 0}}) {
        for (int k = 0; k < 3; ++k) {
            Normal here = seam, there = seam;
            here[static_cast<std::size_t>(k)] += 1e-6f;
            there[static_cast<std::size_t>(k)] -= 1e-6f;
            for (int i = 0; i < 300; ++i) {
                const Normal d = random_direction(random);
                const double a = lit(view, here, d), b = lit(view, there, d);
                EXPECT_NEAR(a, b, 1e-4 * std::max(a, b) + 5e-5 * largest_lit(view, seam, d));
                const double u0 = uniform(random), u1 = uniform(random);
                const auto s = view.sample(here.data(), u0, u1);
                EXPECT_EQ(s.pdf, view.pdf(here.data(), s.direction));
            }
        }
        const std::vector<double> p = square_probabilities(view, seam.data());
        acdf::compress::Sum sum;
        for (const double x : p) sum.add(x);
        EXPECT_NEAR(sum.value(), 1.0, 1e-9);
    }
}

} // namespace
