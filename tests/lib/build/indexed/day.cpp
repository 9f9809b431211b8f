// A day of skies in one file: how noisy it is at its maps and between them, and that it is unbiased there.
#include "tests/inputs/sanitized.h"
#include "tests/lib/build/indexed/skies.h"
#include "tests/lib/compress/chi_square.h"

#include "build/indexed/texels.h"

#include <acdf/grid.h>

#include <tbb/global_control.h>

#include <cmath>
#include <random>

using namespace acdf_test;

namespace {

constexpr int kWidth = 256;

std::vector<double> hours(int count) {
    std::vector<double> out;
    for (int i = 0; i < count; ++i) out.push_back(4.5 + 15.0 * i / (count - 1));
    return out;
}

/// What docs/moving.md says: 24 suns and three turbidities in 64 KiB.
class Day : public testing::Test {
protected:
    static void SetUpTestSuite() {
        if (kSanitized) return;
        std::vector<SkyMap> maps;
        for (const double hour : hours(24))
            for (const double turbidity : {2.0, 4.0, 6.0}) maps.push_back(day_map(kWidth, hour, turbidity));
        acdf::build::IndexedOptions options = along("time", hours(24));
        options.axes.push_back({"turbidity", {2.0, 4.0, 6.0}});
        day_ = new SkyFile(maps, options);
    }
    static void TearDownTestSuite() { delete day_; }
    void SetUp() override { ACDF_NOT_SANITIZED(); }

    /// Of the variance over that of a file of its own: at hours of all turbidities.
    void expect_near_own(double first_hour, const std::vector<double>& turbidities) {
        double logarithms = 0.0, count = 0.0;
        for (double hour = first_hour; hour < 19.5; hour += 3 * 15.0 / 23.0)
            for (const double turbidity : turbidities) {
                const SkyMap map = day_map(kWidth, hour, turbidity);
                const acdf::MixedEnvironment sky = day_->stored.at(hour, turbidity);
                const double ratio = day_->variance(sky, map) / own_variance(map);
                EXPECT_LE(ratio, 5.0) << hour << ' ' << turbidity;
                logarithms += std::log(ratio);
                count += 1.0;
            }
        EXPECT_LE(std::exp(logarithms / count), 2.0);
    }

    static SkyFile* day_;
};
SkyFile* Day::day_ = nullptr;

TEST_F(Day, isNearlyAsGoodAsAFileForEachMap) { expect_near_own(4.5, {2.0, 4.0, 6.0}); }
TEST_F(Day, isNearlyAsGoodBetweenMaps) { expect_near_own(4.5 + 7.5 / 23.0, {2.0, 3.0, 5.0}); }

TEST_F(Day, tellsTheVarianceThatItHas) {
    ASSERT_EQ(day_->made.accuracy.size(), 72u);
    const SkyMap map = day_map(kWidth, hours(24)[9], 4.0);
    EXPECT_EQ(day_->made.accuracy[9 * 3 + 1].relative_variance,
              day_->variance(day_->stored.at(hours(24)[9], 4.0), map));
    EXPECT_EQ(day_->made.accuracy[9 * 3 + 1].support_violations, 0u);
}

TEST_F(Day, totalsAreLinearBetweenMaps) {
    const double noon = day_map(kWidth, 12.0, 3.0).target.total;
    EXPECT_NEAR(day_->stored.at(12.0, 3.0).total(), noon, 0.01 * noon);
}

/// Estimates of the light between maps, against their own noise; and their counts.
TEST_F(Day, isUnbiasedBetweenMaps) {
    std::mt19937_64 random(3);
    std::uniform_real_distribution<double> unit(0.0, 1.0);
    for (const double hour : {4.8, 9.6, 12.3}) {
        const SkyMap map = day_map(kWidth, hour, 3.0);
        const acdf::build::TexelLookup lookup(map.texels, ACDF_FILTER_BILINEAR);
        const acdf::MixedEnvironment sky = day_->stored.at(hour, 3.0);
        const AcdfGrid grid = {map.target.columns, map.target.rows, ACDF_PARAM_LATLONG};
        constexpr int kSamples = 200000;
        double sum = 0.0, squares = 0.0;
        for (int n = 0; n < kSamples; ++n) {
            const acdf::DirectionSample s = sky.sample(unit(random), unit(random));
            ASSERT_EQ(s.pdf, sky.pdf(s.direction));
            const double d[3] = {s.direction[0], s.direction[1], s.direction[2]};
            const double column = grid.columns * (0.5 - 0.5 * acdf_atan2pi(d[1], d[0]));
            const double row = grid.rows * acdf_atan2pi(std::hypot(d[0], d[1]), d[2]);
            const double weight =
                lookup.at(std::min(column, grid.columns - 1e-9), std::min(row, grid.rows - 1e-9)) / double{s.pdf};
            sum += weight;
            squares += weight * weight;
        }
        const double mean = sum / kSamples, variance = squares / kSamples - mean * mean;
        EXPECT_NEAR(mean, map.target.total, 5.0 * std::sqrt(variance / kSamples)) << hour;
        const double told = day_->variance(sky, map) * map.target.total * map.target.total;
        EXPECT_NEAR(variance, told, 0.1 * told) << hour; // what `measure` says
    }
}

TEST_F(Day, samplesBetweenMapsFollowThePdf) {
    std::mt19937_64 random(11);
    std::uniform_real_distribution<double> unit(0.0, 1.0);
    const acdf::MixedEnvironment sky = day_->stored.at(10.1, 2.6);
    constexpr std::uint32_t kColumns = 64,
                            kRows = 32; // cells of the tree are texels: 4 x 4 of them, 6 x 6 points each
    std::vector<double> probability(kColumns * kRows);
    constexpr std::uint32_t kPoints = 24;
    const acdf::compress::Target fine =
        acdf::compress::empty_target(kColumns * kPoints, kRows * kPoints, ACDF_PARAM_LATLONG);
    for (std::uint32_t y = 0; y < kRows * kPoints; ++y)
        for (std::uint32_t x = 0; x < kColumns * kPoints; ++x) {
            float d[3];
            const double rows = kRows * kPoints, columns = kColumns * kPoints;
            acdf::build::grid_direction(fine, x + 0.5, y + 0.5, d);
            probability[y / kPoints * kColumns + x / kPoints] +=
                double{sky.pdf(d)} * 2.0 * ACDF_PI / columns *
                (std::cos(ACDF_PI * y / rows) - std::cos(ACDF_PI * (y + 1) / rows));
        }
    double integral = 0.0;
    for (const double p : probability) integral += p;
    EXPECT_NEAR(integral, 1.0, 1e-3);
    for (double& p : probability) p /= integral;
    std::vector<std::uint32_t> observed(probability.size());
    for (int n = 0; n < 100000; ++n) {
        const acdf::DirectionSample s = sky.sample(unit(random), unit(random));
        const double column = kColumns * (0.5 - 0.5 * acdf_atan2pi(s.direction[1], s.direction[0]));
        const double row = kRows * acdf_atan2pi(std::hypot(s.direction[0], s.direction[1]), s.direction[2]);
        ++observed[std::min(std::uint32_t(row), kRows - 1) * kColumns +
                   std::min(std::uint32_t(column), kColumns - 1)];
    }
    const ChiSquare test = chi_square(observed, probability);
    EXPECT_GT(test.p_value, 1e-3) << test.statistic << " of " << test.degrees;
    EXPECT_FALSE(test.impossible);
}

// ---- smaller files ----------------------------------------------------------------------------------------

std::vector<SkyMap> morning(int width) {
    std::vector<SkyMap> out;
    for (const double hour : {7.0, 8.0, 9.0, 10.0}) out.push_back(day_map(width, hour, 3.0));
    return out;
}

TEST(Morning, isTheSameForAnyNumberOfThreads) {
    acdf::build::IndexedOptions options = along("time", {7.0, 8.0, 9.0, 10.0});
    options.budget = 8 << 10;
    const std::vector<SkyMap> maps = morning(64);
    const std::vector<std::uint8_t> made = SkyFile(maps, options).made.bytes;
    const tbb::global_control one(tbb::global_control::max_allowed_parallelism, 1);
    EXPECT_EQ(SkyFile(maps, options).made.bytes, made);
    options.codec = ACDF_CODEC_ZLIB;
    const SkyFile packed(maps, options);
    EXPECT_LE(packed.made.bytes.size(), made.size());
    EXPECT_EQ(packed.made.mean_variance, SkyFile(maps, options).made.mean_variance);
}

TEST(Morning, aSunThatIsNotOneMovesIntoTwo) {
    acdf::build::IndexedOptions options = along("time", {7.0, 8.0, 9.0, 10.0});
    options.budget = 16 << 10;
    const std::vector<SkyMap> maps = morning(128);
    const SkyFile cone(maps, options);
    EXPECT_EQ(cone.made.suns, 4u);
    options.sun = false;
    const SkyFile smeared(maps, options);
    EXPECT_EQ(smeared.made.suns, 0u);
    const SkyMap between = day_map(128, 8.5, 3.0);
    EXPECT_LT(cone.variance(cone.stored.at(8.5), between), 2.0);
    EXPECT_GT(smeared.variance(smeared.stored.at(8.5), between),
              10.0 * cone.variance(cone.stored.at(8.5), between));
}

} // namespace
