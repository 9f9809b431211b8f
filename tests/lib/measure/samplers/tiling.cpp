// Tiling on the fly: that its bounds hold and are tight, its pdf is that of its samples, and its variance is
// what samples show.
#include "tests/lib/measure/samplers/baselines.h"

#include "measure/samplers/tiling.h"

namespace {

using namespace acdf::measure;
using namespace acdf_test;
using acdf::compress::Target;

struct Tiles {
    std::uint32_t columns, rows;
};

/// For a target of 48 x 24 that is 1 everywhere, pdf * sum of weights is the tile's bound.
class TilingBounds : public ::testing::TestWithParam<Tiles> {};

TEST_P(TilingBounds, AreTheLargestCosines) {
    const Target t = sphere_target(48, 24, [](double, double) { return 1.0; });
    const auto [columns, rows] = GetParam();
    const TilingOnTheFly tiling(t, columns, rows);
    std::vector<Normal> normals = random_normals(60, 5);
    for (const Normal& n : awkward_normals()) normals.push_back(n);
    for (const Normal& n : normals) {
        const TilingOnTheFly::Point point = tiling.at(n.data());
        const double sum = point.cumulative.back();
        std::vector<double> bound(std::size_t{columns} * rows, 0.0), seen(bound.size(), 0.0);
        for (std::uint32_t texel = 0; texel < 48 * 24; ++texel) {
            const std::uint32_t r = texel / 48, c = texel % 48;
            std::uint32_t tile_r = 0, tile_c = 0;
            while ((tile_r + 1) * 24 / rows <= r) ++tile_r;
            while ((tile_c + 1) * 48 / columns <= c) ++tile_c;
            const std::size_t tile = std::size_t{tile_r} * columns + tile_c;
            const auto direction = [&](double right, double down) {
                Normal w;
                direction_of(kPi - 2.0 * kPi * (c + right) / 48, std::cos(kPi * (r + down) / 24), w.data());
                return w;
            };
            bound[tile] = tiling.pdf(point, direction(0.5, 0.5).data()) * sum;
            for (int i = 0; i < 25; ++i) // corners and borders too
                seen[tile] = std::max(seen[tile], dot(n.data(), direction(i % 5 / 4.0, i / 5 / 4.0).data()));
        }
        for (std::size_t i = 0; i < bound.size(); ++i) {
            ASSERT_GE(bound[i], seen[i] - 1e-6);
            ASSERT_LE(bound[i],
                      seen[i] + 5e-4); // the crest is at most an eighth of a texel, 0.016, off in both angles
        }
    }
}

INSTANTIATE_TEST_SUITE_P(All, TilingBounds,
                         ::testing::Values(Tiles{1, 1}, Tiles{2, 1}, Tiles{1, 2}, Tiles{3, 2}, Tiles{16, 8},
                                           Tiles{7, 5}, Tiles{48, 24}),
                         [](const auto& info) {
                             return std::to_string(info.param.columns) + "x" + std::to_string(info.param.rows);
                         });

// Cones are wider than tiles, by less the smaller these are.
TEST(TilingBounds, OfTheSquareHold) {
    const Target t = octahedral(sphere_target(48, 48, [](double, double) { return 1.0; }));
    for (const std::uint32_t side : {1u, 2u, 3u, 8u, 48u}) {
        const TilingOnTheFly tiling(t, side, side);
        for (const Normal& n : awkward_normals()) {
            const TilingOnTheFly::Point point = tiling.at(n.data());
            for_each_direction(t, 3, [&](std::size_t, const double* d, double) {
                const Normal w{static_cast<float>(d[0]), static_cast<float>(d[1]), static_cast<float>(d[2])};
                const double bound = tiling.pdf(point, w.data()) * point.cumulative.back();
                ASSERT_GE(bound, std::max(dot(n.data(), w.data()), 0.0) - 1e-6);
                ASSERT_LE(bound, std::max(dot(n.data(), w.data()), 0.0) + 8.0 / side);
            });
        }
    }
}

class Tiling : public ::testing::TestWithParam<NamedTarget> {
protected:
    const Target& target() const { return GetParam().target; }
    TilingOnTheFly tiling() const {
        return TilingOnTheFly(target(), std::min(8u, target().columns), std::min(4u, target().rows));
    }
};

TEST_P(Tiling, PdfIsThatOfSamples) {
    const Target& t = target();
    const TilingOnTheFly baseline = tiling();
    std::mt19937_64 random(3);
    for (const Normal& n : awkward_normals()) {
        const TilingOnTheFly::Point point = baseline.at(n.data());
        if (!(point.cumulative.back() > 0.0)) {
            EXPECT_EQ(baseline.sample(point, 0.5, 0.5).pdf, 0.0f);
            continue;
        }
        std::vector<double> probability(t.values.size());
        double sum = 0.0;
        for_each_direction(t, 1, [&](std::size_t i, const double* d, double omega) {
            const float w[3] = {static_cast<float>(d[0]), static_cast<float>(d[1]), static_cast<float>(d[2])};
            sum += probability[i] = baseline.pdf(point, w) * omega;
        });
        EXPECT_NEAR(sum, 1.0, 1e-5);
        std::vector<std::uint32_t> observed(t.values.size(), 0);
        for (int i = 0; i < 20000; ++i) {
            const AcdfDirectionSample s = baseline.sample(point, uniform(random), uniform(random));
            ASSERT_GT(s.pdf, 0.0f);
            ASSERT_FLOAT_EQ(s.pdf, baseline.pdf(point, s.direction));
            ++observed[texel_of(t, s.direction)];
        }
        const ChiSquare test = chi_square(observed, probability);
        EXPECT_FALSE(test.impossible);
        EXPECT_GT(test.p_value, sidak(0.01, 90));
    }
}

TEST_P(Tiling, EveryLitDirectionAboveTheHorizonHasAPdf) {
    const Target& t = target();
    const TilingOnTheFly baseline = tiling();
    std::mt19937_64 random(4);
    for (const Normal& n : awkward_normals()) {
        const TilingOnTheFly::Point point = baseline.at(n.data());
        for (int i = 0; i < 3000; ++i) {
            const Normal w = random_direction(random);
            if (dot(n.data(), w.data()) > 0.0 && t.values[texel_of(t, w.data())] > 0.0f) {
                ASSERT_GT(baseline.pdf(point, w.data()), 0.0f);
            }
        }
    }
}

class TilingVariance : public Tiling {};

TEST_P(TilingVariance, VarianceIsThatOfSamples) {
    const Target& t = target();
    const TilingOnTheFly baseline = tiling();
    const double flux = acdf::compress::integral(t);
    const double centres = 1e-3 * flux * flux; // the cosine's variance within such a texel
    std::mt19937_64 random(5);
    for (const Normal& n : awkward_normals()) {
        const TilingOnTheFly::Point point = baseline.at(n.data());
        if (!(point.cumulative.back() > 0.0)) continue;
        const MonteCarlo seen = monte_carlo(20000, [&] {
            const AcdfDirectionSample s = baseline.sample(point, uniform(random), uniform(random));
            const double cosine = dot(n.data(), s.direction);
            return cosine > 0.0 ? t.values[texel_of(t, s.direction)] * cosine / s.pdf : 0.0;
        });
        const double mean = irradiance(t, n);
        EXPECT_NEAR(seen.mean, mean, 4.5 * seen.mean_error + 2e-3 * mean);
        const double second = (1.0 + baseline.relative_variance(n.data())) * mean * mean;
        EXPECT_NEAR(seen.second, second, 4.5 * seen.second_error + centres);
    }
}

INSTANTIATE_TEST_SUITE_P(Synthetic, Tiling, ::testing::ValuesIn(irradiance_targets()),
                         [](const auto& info) { return info.param.name; });
INSTANTIATE_TEST_SUITE_P(Synthetic, TilingVariance, ::testing::ValuesIn(fine_targets()),
                         [](const auto& info) { return info.param.name; });

// One tile is the full CDF; a tile a texel leaves the cosine's variation within a texel.
TEST(TilingOnTheFly, FromTheFullCdfToTheIntegrand) {
    const Target t = noise_target(64, 32, 3);
    for (const Normal& n : awkward_normals()) {
        double last = INFINITY;
        for (const std::uint32_t tiles : {1u, 2u, 4u, 8u, 16u, 32u}) {
            const double variance = TilingOnTheFly(t, 2 * tiles, tiles).relative_variance(n.data());
            EXPECT_LT(variance, last * 1.0001) << tiles; // along an axis tiles may add nothing
            last = variance;
        }
        EXPECT_LT(last, 0.03);
    }
}

TEST(TilingOnTheFly, RefusesAndCountsBytes) {
    const Target t = noise_target(256, 128, 3);
    EXPECT_THROW(TilingOnTheFly(t, 257, 4), std::invalid_argument);
    EXPECT_THROW(TilingOnTheFly(t, 4, 0), std::invalid_argument);
    EXPECT_THROW(TilingOnTheFly(sphere_target(8, 4, [](double, double) { return 0.0; }), 2, 2),
                 std::invalid_argument);
    EXPECT_NEAR(static_cast<double>(TilingOnTheFly(t, 8, 4).bytes()) / (256 * 128), 8.0, 0.6);
}

} // namespace
