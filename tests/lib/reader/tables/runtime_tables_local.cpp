// Runtime tables of local environments beside the traversal that they replace: the same pdf to the bit for every
// direction and normal, and the same samples but for rounding, on golden files, random ones, those that break their
// luck, and a fitted one.
#include "tests/inputs/local_maps.h"
#include "tests/lib/reader/golden_files.h"
#include "tests/lib/reader/local_builder.h"
#include "tests/lib/reader/local_random.h"
#include "tests/lib/reader/tables/tables_pair.h"

#include <acdf/product/cut.h>
#include <acdf/reader.h>
#include <acdf/views.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <random>
#include <utility>
#include <vector>

namespace {

using namespace acdf_test;

struct LocalPair : TablesPair {
    using TablesPair::TablesPair;
    const AcdfLocalTables* tables() const { return fast.local().data().tables; }
};

struct LocalServed {
    std::size_t asked = 0, told = 0; ///< directions, and those that tables knew
};

bool same_bits(float a, float b) { return std::memcmp(&a, &b, sizeof a) == 0; }

void expect_same(const LocalPair& pair, const AcdfLocalPoint points[2], const float direction[3],
                 LocalServed& served) {
    const float fast = pair.fast.local().pdf(points[0], direction);
    const float plain = pair.plain.local().pdf(points[1], direction);
    ASSERT_TRUE(same_bits(fast, plain))
        << fast << " is not " << plain << " at " << direction[0] << ' ' << direction[1] << ' ' << direction[2];
    ++served.asked;
    served.told += pair.tables() && pair.tables()->pieces && acdf_local_find_piece(pair.tables(), direction);
}

/// Whether two samples are of one cell and at one position but for the rounding of floats. (Where a share is
/// sampled around the normal the pdf depends on the position.)
bool same_sample(const acdf::DirectionSample& a, const acdf::DirectionSample& b, double most) {
    for (int i = 0; i < 3; ++i)
        if (!(std::fabs(double{a.direction[i]} - b.direction[i]) <= most)) return false;
    return std::fabs(double{a.pdf} - b.pdf) <= 1e-5 * b.pdf;
}

/// A sample is that of the traversal but next to borders, where it is that of numbers 2^-24 away. Its pdf is what
/// the same view returns for it, where that holds of the traversal: cells without tilts.
void expect_same_sample(const LocalPair& pair, const AcdfLocalPoint points[2], const double u[2]) {
    const acdf::DirectionSample a = pair.fast.local().sample(points[0], u[0], u[1]);
    const acdf::DirectionSample b = pair.plain.local().sample(points[1], u[0], u[1]);
    if (a.pdf > 0.0f && same_bits(b.pdf, pair.plain.local().pdf(points[1], b.direction))) {
        ASSERT_TRUE(same_bits(a.pdf, pair.fast.local().pdf(points[0], a.direction))) << u[0] << ' ' << u[1];
    }
    if (same_sample(a, b, 4e-7)) return;
    bool near = false;
    for (int k = 0; k < 9 && !near; ++k)
        near = same_sample(
            a, pair.plain.local().sample(points[1], u[0] + 0x1p-24 * (k % 3 - 1), u[1] + 0x1p-24 * (k / 3 - 1)),
            1e-4);
    ASSERT_TRUE(near) << u[0] << ' ' << u[1] << ' ' << a.pdf;
}

/// Samples of a normal and their pdfs, directions anywhere, and such beside borders between squares.
void expect_same(const LocalPair& pair, const float normal[3], std::mt19937_64& random, LocalServed& served,
                 LocalServed& edges) {
    const AcdfLocalPoint points[2] = {pair.fast.local().at(normal), pair.plain.local().at(normal)};
    const AcdfEnvironment env = pair.plain.local().data().environment;
    for (int i = 0; i < 8 && !testing::Test::HasFatalFailure(); ++i) {
        const double u0 = uniform(random), u1 = uniform(random);
        const double u[2] = {i == 0 ? 0.0 : u0, i == 1 ? 1.0 : u1};
        expect_same_sample(pair, points, u);
        const acdf::DirectionSample a = pair.fast.local().sample(points[0], u0, u1);
        if (a.pdf > 0.0f) expect_same(pair, points, a.direction, served);
        const Normal any = random_direction(random);
        expect_same(pair, points, any.data(), served);
        const double off = (uniform(random) - 0.5) * std::exp2(-18.0 - 12.0 * uniform(random));
        const double column = static_cast<double>(random() % (env.columns + 1)),
                     row = static_cast<double>(random() % (env.rows + 1));
        float beside[3];
        direction_of(kPi * (1.0 - 2.0 * column / env.columns) + off, 1.0 - 2.0 * uniform(random), beside);
        expect_same(pair, points, beside, edges);
        direction_of(2.0 * kPi * uniform(random), std::cos(kPi * row / env.rows + off), beside);
        expect_same(pair, points, beside, edges);
        direction_of(0.25 * kPi * static_cast<double>(random() % 8), 1.0 - std::exp(-30.0 * uniform(random)),
                     beside);
        expect_same(pair, points, beside, edges); // at the seams of pieces, close to the poles
        for (float& d : beside) d *= 1.0003f;     // not quite of unit length: it counts all the same
        expect_same(pair, points, beside, edges);
        beside[random() % 3] = std::nanf("");
        expect_same(pair, points, beside, edges);
    }
}

LocalServed expect_agreement(const LocalPair& pair, int normals) {
    std::mt19937_64 random(6);
    LocalServed served, edges;
    for (int i = 0; i < normals && !testing::Test::HasFatalFailure(); ++i) {
        Normal normal = random_direction(random);
        if (i % 4 == 0) normal = edge_normal(random);
        expect_same(pair, normal.data(), random, served, edges);
    }
    return served;
}

TEST(LocalRuntimeTables, AgreeOnGoldenFiles) {
    int files = 0, with_tables = 0;
    each_golden_file([&](std::vector<std::uint8_t> bytes) {
        LocalPair pair(std::move(bytes));
        if (pair.plain.kind() != ACDF_KIND_LOCAL) return;
        ++files;
        with_tables += pair.tables() != nullptr;
        expect_agreement(pair, 300);
    });
    EXPECT_GE(files, 3);
    EXPECT_GE(with_tables, 1);
}

// Shared curves, dark segments, tiles that are cells, bright tiles, tilts, both parameterizations.
TEST(LocalRuntimeTables, AgreeOnRandomFiles) {
    int with_tables = 0;
    for (std::uint32_t seed = 0; seed < 120; ++seed) {
        RandomOptions options = varied_local_options(seed);
        options.depth = 3 + static_cast<int>(seed % 3);
        options.tilts = seed % 8 == 0;
        options.long_curves = false;
        options.octahedral = seed % 10 == 9;
        SCOPED_TRACE(seed);
        LocalPair pair(RandomLocal(seed, options).make().encode());
        with_tables += pair.tables() != nullptr;
        expect_agreement(pair, 60);
        if (HasFatalFailure()) return;
    }
    EXPECT_GT(with_tables, 40);
}

TEST(LocalRuntimeTables, AgreeOnHandMadeLights) {
    LocalPair pair(lit_local().encode());
    ASSERT_NE(pair.tables(), nullptr);
    expect_agreement(pair, 500);
}

/// What SPEC.md leaves open of the sum of the weights of bright tiles.
void expect_same_lights(const AcdfLocalPoint& a, const AcdfLocalPoint& b) {
    ASSERT_EQ(a.bright_tiles > 0.0, b.bright_tiles > 0.0);
    ASSERT_NEAR(a.bright_tiles, b.bright_tiles, 0x1p-39 * b.bright_tiles);
    ASSERT_NEAR(a.sum, b.sum, 0x1p-39 * b.sum);
}

// Points are what the traversal makes of a normal: to the bit, but for the sum of bright tiles.
TEST(LocalRuntimeTables, MakeTheSamePoints) {
    LocalPair pair(lit_local().encode());
    std::mt19937_64 random(8);
    for (int i = 0; i < 3000; ++i) {
        Normal normal = random_direction(random);
        if (i % 3 == 0) normal = edge_normal(random);
        if (i % 5 == 0) normal[random() % 3] = i % 2 == 0 ? 0.0f : -0.0f;
        const AcdfLocalPoint a = pair.fast.local().at(normal.data()), b = pair.plain.local().at(normal.data());
        ASSERT_EQ(a.what, b.what);
        ASSERT_EQ(a.mix.count, b.mix.count);
        ASSERT_EQ(a.scale, b.scale);
        ASSERT_EQ(a.length, b.length);
        expect_same_lights(a, b);
        for (int k = 0; k < a.mix.count; ++k) {
            ASSERT_EQ(a.mix.weight[k], b.mix.weight[k]);
            ASSERT_EQ(a.mix.row[k] - pair.fast.local().data().blend.rows,
                      b.mix.row[k] - pair.plain.local().data().blend.rows);
        }
    }
}

/// A normal at whose horizon a light stands, or nearly so: above it, cut by it, below.
Normal horizon_of(const AcdfBrightTile& light, std::mt19937_64& random) {
    const float* const d = light.direction;
    const Normal any = random_direction(random);
    const float height = light.radius * (static_cast<float>(random() % 9) - 4.0f) * 0.25f;
    const float along = any[0] * d[0] + any[1] * d[1] + any[2] * d[2] - height;
    return {any[0] - along * d[0], any[1] - along * d[1], any[2] - along * d[2]};
}

// Tables weigh bright tiles two at a time, and most of a facet together: any number of them, and those that the
// horizon cuts.
TEST(LocalRuntimeTables, WeighLightsAsTheFileDoes) {
    std::size_t odd = 0, even = 0, cut_by_horizon = 0, of_facets = 0;
    for (std::uint32_t seed = 0; seed < 60; ++seed) {
        const LocalPair pair(RandomLocal(seed, varied_local_options(seed)).make().encode());
        const AcdfLocal fast = pair.fast.local().data(), plain = pair.plain.local().data();
        if (!fast.tables || fast.bright_tile_count < 2) continue;
        ++(fast.bright_tile_count % 2 > 0 ? odd : even);
        std::mt19937_64 random(seed);
        for (int i = 0; i < 100; ++i) {
            const Normal normal = i % 2 == 0
                                      ? random_direction(random)
                                      : horizon_of(plain.bright_tiles[random() % plain.bright_tile_count], random);
            const AcdfLocalPoint a = pair.fast.local().at(normal.data()), b = pair.plain.local().at(normal.data());
            expect_same_lights(a, b);
            if (a.what != ACDF_LOCAL_BLEND) continue;
            of_facets += a.by.tabled.facet != nullptr && a.by.tabled.facet->whole[0] != 0.0;
            AcdfCut cuts[2];
            acdf_cut_begin(&fast, &a, &cuts[0]);
            acdf_cut_begin(&plain, &b, &cuts[1]);
            const AcdfScaledNormal at = acdf_local_scaled_normal(&b);
            for (std::uint32_t k = 0; k < fast.bright_tile_count; ++k) {
                const AcdfBrightTile& light = plain.bright_tiles[k];
                const double height = at.normal[0] * light.direction[0] + at.normal[1] * light.direction[1] +
                                      at.normal[2] * light.direction[2];
                cut_by_horizon += std::fabs(height) < light.radius * at.length;
                ASSERT_EQ(cuts[0].light[k], acdf_bright_tile_weight(&light, &at));
                ASSERT_EQ(cuts[1].light[k], acdf_bright_tile_weight(&light, &at));
            }
        }
    }
    EXPECT_GT(odd, 0u);
    EXPECT_GT(even, 0u);
    EXPECT_GT(cut_by_horizon, 100u);
    EXPECT_GT(of_facets, 20u);
}

// Rows of several cache lines, whose splits have other numbers in the tables.
TEST(LocalRuntimeTables, AgreeOnManyTiles) {
    const auto sky = texel_target(128, 64, [](std::uint32_t c, std::uint32_t r) {
        return 1.0 +
               smooth_sky(centre_phi(c, 128), centre_z(r, 64)) * static_cast<double>(1 + (c * 7 + r * 13) % 17);
    });
    LocalFileOptions options;
    options.size.tiles = 400;
    const LocalMap map(sky, acdf::compress::octahedral_bins(2), options);
    LocalPair pair(map.bytes);
    ASSERT_NE(pair.tables(), nullptr);
    EXPECT_GT(pair.tables()->tiles.stride, 320u);
    expect_agreement(pair, 300);
}

// As many tiles as files in use have: the tables answer nearly all calls, in bounded memory.
TEST(LocalRuntimeTables, ServeNearlyAllOfUsualFiles) {
    const auto sky = texel_target(128, 64, [](std::uint32_t c, std::uint32_t r) {
        const double phi = centre_phi(c, 128), z = centre_z(r, 64);
        return std::hypot(phi - 0.6, z - 0.7) < 0.06 ? 3e3 : smooth_sky(phi, z);
    });
    LocalFileOptions options;
    options.size.tiles = 100;
    for (const auto& target : {sky, octahedral(sky)}) {
        const LocalMap map(target, acdf::compress::octahedral_bins(4), options);
        LocalPair pair(map.bytes);
        ASSERT_NE(pair.tables(), nullptr);
        const LocalServed served = expect_agreement(pair, 1000);
        EXPECT_GT(double(served.told), 0.99 * double(served.asked));
    }
}

// Numbers of corners are those of the levels that SPEC.md counts.
TEST(LocalRuntimeTables, CornersAreCountedLevelByLevel) {
    for (const std::uint32_t n : {1u, 2u, 5u, 12u}) {
        const auto size = static_cast<std::int32_t>(n);
        std::uint32_t expected = 0;
        for (std::int32_t z = size; z >= -size; --z) {
            const std::int32_t r = size - std::abs(z);
            EXPECT_EQ(acdf_octahedral_corner(n, r, 0, z), expected);
            for (std::int32_t i = 0; i < 4 * r; ++i, ++expected) {
                const std::int32_t side = i / r, step = i % r; // from +x towards +y
                const std::int32_t x[4] = {r - step, -step, step - r, step},
                                   y[4] = {step, r - step, -step, step - r};
                EXPECT_EQ(acdf_octahedral_corner(n, x[side], y[side], z), expected);
            }
            expected += r == 0;
        }
        EXPECT_EQ(expected, 4 * n * n + 2);
    }
}

} // namespace
