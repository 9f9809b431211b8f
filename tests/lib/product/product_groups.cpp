// What cuts of the fast shape are made of (acdf/product/fast_cut.h), beside plain sums over the rows.
#include "tests/lib/product/product_points.h"

#include <acdf/product/fast_cut.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

using namespace acdf_test;
using namespace acdf_test::products;

namespace {

template <class Visit>
void each_cut_file(const Visit& visit) {
    for (std::uint32_t seed = 0; seed < 24; ++seed) {
        RandomOptions options;
        options.columns = options.rows = 48;
        options.octahedral = seed % 2 == 1;
        options.long_curves = options.tilts = false;
        RandomFast random(seed, options);
        const LoadedLocal loaded(seed % 3 == 0 ? random.make_cut_evenly(24, 1 + seed % 12) : random.make());
        const AcdfLocal light = loaded.light();
        ASSERT_TRUE(acdf_fast_cut_serves(&light)) << seed;
        visit(light, seed);
    }
}

TEST(FastCut, TablesHaveTheTileThatGetsMostAndSolidAngles) {
    each_cut_file([](const AcdfLocal& light, std::uint32_t seed) {
        const AcdfGrid grid = acdf_environment_grid(&light.environment);
        const std::uint32_t tiles = light.blend.tiles->tile_count, groups = acdf_fast_group_count(tiles);
        std::vector<double> angles(light.fast.ends, 0.0);
        for (std::uint32_t tile = 0; tile < tiles; ++tile) {
            AcdfRange range[2];
            acdf_sphere_ranges(grid.columns, grid.rows, range);
            acdf_tile_range(acdf_local_tile(light.tables, tile), range);
            const double angle = acdf_grid_solid_angle(&grid, range);
            angles[tile / ACDF_FAST_GROUP] += angle;
            const float* middle = acdf_local_middle(light.tables, tile);
            ASSERT_NEAR(middle[3], angle, 1e-6 * angle);
            std::uint32_t square[2];
            ASSERT_TRUE(acdf_local_square(&grid, middle, square));
            for (int axis = 0; axis < 2; ++axis) // on the border of two squares, or in one
                ASSERT_TRUE(range[axis].low <= square[axis] + 1 && square[axis] <= range[axis].high) << seed;
        }
        for (std::uint32_t i = 0; i < light.fast.ends; ++i)
            ASSERT_NEAR(acdf_local_group_angles(light.tables)[i], angles[i], 1e-5 * angles[i]);
        for (std::uint32_t row = 0; row < light.blend.tiles->row_count; ++row)
            for (std::uint32_t group = 0; group < groups; ++group) {
                const std::uint8_t* ends = light.fast.tiles + std::size_t{row} * light.fast.stride + 16 * group;
                const auto given = [&](int i) { return ends[i] - (i > 0 ? ends[i - 1] : 0); };
                const int heart = acdf_local_group_hearts(light.tables, row, light.fast.ends)[group];
                for (int i = 0; i < 16; ++i) ASSERT_LE(given(i), given(heart)) << seed;
                ASSERT_LT(16 * group + static_cast<std::uint32_t>(heart), tiles);
            }
    });
}

TEST(FastCut, MassesAreWhatPdfsFind) {
    int given = 0;
    each_cut_file([&](const AcdfLocal& light, std::uint32_t seed) {
        std::mt19937_64 rng(seed);
        for (int i = 0; i < 20; ++i) {
            AcdfLocalPoint point;
            acdf_local_at(&light, random_normal(rng).v, &point);
            if (point.what != ACDF_LOCAL_FAST || point.mix.count == 0) continue;
            std::int32_t masses[ACDF_FAST_CUT_GROUPS], tiles[ACDF_FAST_GROUP];
            acdf_fast_group_masses(&light.fast, &point.by.fast.mix, masses);
            const std::uint32_t groups = acdf_fast_group_count(light.blend.tiles->tile_count);
            for (std::uint32_t g = groups; g < light.fast.ends; ++g) ASSERT_EQ(masses[g], 0);
            for (std::uint32_t g = 0; g < groups; ++g) {
                const AcdfFastGroup group = acdf_fast_find_group(&point.by.fast.mix, g);
                ASSERT_EQ(masses[g], group.mass) << seed;
                acdf_fast_tile_masses(&point.by.fast.mix, &group, ACDF_FAST_GROUP * g, tiles);
                for (std::uint32_t t = 0; t < ACDF_FAST_GROUP; ++t)
                    ASSERT_EQ(tiles[t], acdf_fast_find_tile(&point.by.fast.mix, &group, ACDF_FAST_GROUP * g, t))
                        << seed;
                given += masses[g] > 0;
            }
        }
    });
    EXPECT_GT(given, 1000);
}

// Any shares, most of them none: the ends give each part its share to 2^-29 and the steps of all, and nothing to
// those that have none.
TEST(FastCut, EndsAreSharesInSteps) {
    std::mt19937_64 rng(2);
    for (int turn = 0; turn < 200; ++turn) {
        AcdfFastCut cut;
        std::vector<float> share(ACDF_FAST_CUT_PARTS, 0.0f);
        double sum = 0.0;
        cut.bright_tiles = 16;
        cut.count = 16 * (2 + static_cast<std::uint32_t>(rng() % (ACDF_FAST_CUT_PARTS / 16 - 1)));
        for (std::uint32_t i = 0; i < cut.count; ++i) {
            share[i] =
                rng() % 4 == 0 ? static_cast<float>(std::ldexp(uniform(rng), -static_cast<int>(rng() % 60))) : 0.0f;
            sum += double{share[i]};
        }
        for (float& x : share) x = static_cast<float>(double{x} / sum);
        acdf_fast_cut_finish(&cut, share.data());
        ASSERT_NEAR(cut.whole, 0x1p29, 0x1p29 * 1e-6 + cut.count);
        for (std::uint32_t i = 0; i < cut.count; ++i) {
            const AcdfFastPart part = acdf_fast_cut_part(cut.end, i);
            ASSERT_EQ(part.mass > 0.0, share[i] > 0.0f);
            ASSERT_NEAR(part.mass, double{share[i]} * 0x1p29, 1.0 + double{share[i]} * 64.0);
        }
        for (int i = 0; i < 200; ++i) { // the first end above any number
            const double x = std::floor(uniform(rng) * cut.whole);
            std::uint32_t block = 0;
            for (; !(cut.upper[block + 15] > x); block += 16) ASSERT_LT(block, std::uint32_t{ACDF_FAST_CUT_UPPER});
            block += acdf_fast_cut_search(cut.upper + block, x);
            const std::uint32_t found = 16 * block + acdf_fast_cut_search(cut.end + 16 * block, x);
            ASSERT_EQ(found,
                      static_cast<std::uint32_t>(std::upper_bound(cut.end, cut.end + cut.count, x) - cut.end));
        }
    }
}

} // namespace
