// Rows made for the normals between bins, beside those that are best for the bins themselves.
#include "tests/inputs/local_maps.h"

#include "compress/local/mixed_rows.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <memory>
#include <numeric>

using namespace acdf_test;

namespace {

using namespace acdf::compress;

struct Tiled {
    Target target = suns_target(256, 128);
    NormalBins bins;
    TileTree tiles;
    std::unique_ptr<TileCurves> curves;
    std::unique_ptr<TileCascade> cascade;
    std::unique_ptr<TileLight> light;

    explicit Tiled(std::uint32_t subdivisions) : bins(octahedral_bins(subdivisions)) {
        const Worth light_worth = worth(target, bins, irradiance(light_points(target), bins));
        tiles = divide_tiles(target, light_worth, 300);
        curves = std::make_unique<TileCurves>(target, tiles.tiles, std::vector<double>(tiles.tiles.size(), 1.0));
        curves->refine(1e-4);
        cascade = std::make_unique<TileCascade>(tiles, *curves, 1e-4, WholeTree::of_tiles);
        light = std::make_unique<TileLight>(target, tiles, *cascade, std::vector<AcdfBrightTile>());
    }

    TileParts own_rows() const {
        TileParts out;
        for (const Direction& normal : bins.normals) {
            const std::vector<double> costs = light->costs(normal);
            out.emplace_back(costs.begin(), costs.end());
        }
        return out;
    }
};

/// Of what a normal samples from the mixture of its bins.
struct Mixed {
    double moment = 0.0; ///< E[(f/p)^2] over the square of the mean, as far as tiles resolve it
    double vain = 0.0;   ///< share of the samples below the horizon
};

Mixed mixed(const Tiled& map, const TileParts& rows, const Normal& normal) {
    AcdfNormalBins served;
    EXPECT_TRUE(map.bins.find(normal.data(), served));
    const double size = length(normal.data());
    TileView view;
    map.light->look({normal[0] / size, normal[1] / size, normal[2] / size}, view);
    double moment = 0.0, sum = 0.0, vain = 0.0;
    for (std::size_t t = 0; t < view.cost.size(); ++t) {
        double part = 0.0;
        for (int i = 0; i < served.count; ++i) part += served.weight[i] * double{rows[served.bin[i]][t]};
        if (!(part > 0.0)) continue;
        moment += view.cost[t] * view.cost[t] / part;
        sum += part;
        vain += part * view.hidden[t];
    }
    const double irradiance = std::accumulate(view.cost.begin(), view.cost.end(), 0.0);
    return {moment * sum / (irradiance * irradiance), vain / sum};
}

TEST(MixedRows, HaveLessVarianceAndFewerSamplesInVainThanRowsOfTheirOwn) {
    for (const std::uint32_t subdivisions : {3u, 8u}) {
        const Tiled map(subdivisions);
        const TileParts own = map.own_rows(), rows = mixed_rows(*map.light, map.bins, {});
        std::mt19937_64 random(5);
        double variance[2] = {}, worst[2] = {};
        for (int i = 0; i < 400; ++i) {
            const Normal normal = random_direction(random);
            const Mixed before = mixed(map, own, normal), after = mixed(map, rows, normal);
            variance[0] += before.moment - 1.0;
            variance[1] += after.moment - 1.0;
            worst[0] = std::max(worst[0], before.vain);
            worst[1] = std::max(worst[1], after.vain);
        }
        EXPECT_LT(variance[1], 0.85 * variance[0]) << subdivisions;
        EXPECT_LT(worst[1], 0.8 * worst[0]) << subdivisions;
    }
}

TEST(MixedRows, KeepWhatACornerSees) {
    const Tiled map(5);
    const TileParts own = map.own_rows(), rows = mixed_rows(*map.light, map.bins, {});
    for (std::size_t b = 0; b < rows.size(); ++b)
        for (std::size_t t = 0; t < rows[b].size(); ++t) {
            ASSERT_EQ(rows[b][t] > 0.0f, own[b][t] > 0.0f) << b << ' ' << t;
            ASSERT_GE(double{rows[b][t]}, 0.249 * double{own[b][t]}) << b << ' ' << t;
        }
}

TEST(MixedRows, BinsThatAreNotStoredHaveNone) {
    Tiled map(4);
    const SceneNormal scene = {{0.2f, 0.1f, 0.9f}, 1.0};
    weigh(map.bins, {scene});
    const TileParts rows = mixed_rows(*map.light, map.bins, {});
    std::size_t stored = 0;
    for (std::size_t b = 0; b < rows.size(); ++b) {
        EXPECT_EQ(rows[b].empty(), !(map.bins.weight[b] > 0.0));
        stored += !rows[b].empty();
    }
    EXPECT_EQ(stored, 3u);
}

} // namespace
