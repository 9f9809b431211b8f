// Every fit on probes at the ends of what numbers can hold: stored in each way, read, measured and sampled.
#include "tests/extremes/targets.h"
#include "tests/inputs/environment_file.h"
#include "tests/lib/compress/checks.h"

#include "build/accuracy/environment.h"

#include <acdf/curves/curves.h>
#include <acdf/reader.h>
#include <acdf/views.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <random>

namespace {

using namespace acdf_test;
using acdf::compress::Target;

class Extreme : public ::testing::TestWithParam<NamedTarget> {
protected:
    const Target& target() const { return GetParam().target; }
};

TEST_P(Extreme, EveryFitIsAPdfThatCoversIt) {
    for (const NamedFit& fit : all_fits(9, 7, 60)) check_fit(target(), fit);
}

// f/p is what a renderer adds up.
TEST_P(Extreme, WeightsAreFiniteAndEveryNumberSamplesSomething) {
    const double numbers[] = {0.0, 1.0, 1.0 - 0x1p-24, 0x1p-149, 0x1p-24, 0.5, 0.25, 1.0 / 3, -1.0, 2.0, NAN};
    for (const NamedFit& fit : all_fits(9, 7, 60)) {
        SCOPED_TRACE(fit.name);
        const auto bytes = environment_file(target(), fit.options);
        acdf::File file;
        ASSERT_TRUE(acdf::File::from_memory(bytes.data(), bytes.size(), file, acdf::with_curves()).ok());
        const acdf::EnvironmentView view = file.environment();
        for (const double u0 : numbers)
            for (const double u1 : numbers) {
                const acdf::DirectionSample s = view.sample(u0, u1);
                ASSERT_TRUE(std::isfinite(s.pdf) && s.pdf > 0.0f) << u0 << " " << u1;
                std::uint32_t square[2];
                const AcdfGrid grid = acdf_environment_grid(&view.data());
                double position[2];
                ASSERT_TRUE(acdf_grid_square(&grid, s.direction, square, position));
                ASSERT_TRUE(std::isfinite(double{target().row(square[1])[square[0]]} / s.pdf));
            }
    }
}

TEST_P(Extreme, CodecsChangeNoSample) {
    for (const NamedFit& fit : all_fits(9, 7, 60)) {
        const auto plain = environment_file(target(), fit.options);
        acdf::File file;
        ASSERT_TRUE(acdf::File::from_memory(plain.data(), plain.size(), file, acdf::with_curves()).ok());
        for (const AcdfCodec codec : {ACDF_CODEC_ZLIB, ACDF_CODEC_PLANES}) {
            const auto packed = environment_file(target(), fit.options, codec);
            acdf::File other;
            const acdf::Status status =
                acdf::File::from_memory(packed.data(), packed.size(), other, acdf::with_curves());
            ASSERT_TRUE(status.ok()) << fit.name << ": " << status.message;
            std::mt19937_64 random(7);
            for (int i = 0; i < 200; ++i) {
                const double u0 = uniform(random), u1 = uniform(random);
                const auto a = file.environment().sample(u0, u1), b = other.environment().sample(u0, u1);
                ASSERT_EQ(std::memcmp(&a, &b, sizeof a), 0) << fit.name;
            }
        }
    }
}

INSTANTIATE_TEST_SUITE_P(Octahedral, Extreme, ::testing::ValuesIn(octahedral_extremes()),
                         [](const auto& info) { return info.param.name; });
INSTANTIATE_TEST_SUITE_P(Probes, Extreme, ::testing::ValuesIn(extreme_targets()),
                         [](const auto& info) { return info.param.name; });

// A furnace: nothing to gain by any cell.
TEST(ExtremeConstant, IsOneCellWithoutVariance) {
    for (const double value : {1e-44, 1e-30, 1.0, 65504.0, 1e30}) {
        const Target target = texel_target(128, 64, [=](std::uint32_t, std::uint32_t) { return value; });
        acdf::compress::FitOptions options;
        const auto bytes = environment_file(target, options);
        acdf::File file;
        ASSERT_TRUE(acdf::File::from_memory(bytes.data(), bytes.size(), file, acdf::with_curves()).ok());
        const auto accuracy = acdf::build::measure_environment(file, target);
        EXPECT_EQ(accuracy.cells, 1u) << value;
        EXPECT_NEAR(accuracy.relative_variance, 0.0, 1e-13) << value;
        EXPECT_NEAR(accuracy.max_weight, 1.0, 1e-12) << value;
    }
}

// More cells never hurt, however wide the range: what a texel's light gains is never lost among that of a sun.
TEST(ExtremeRange, MoreCellsNeverHurt) {
    for (const NamedTarget& t : extreme_targets()) {
        double previous = INFINITY;
        for (const std::uint32_t cells : {1u, 4u, 16u, 64u, 256u, 1024u}) {
            acdf::compress::FitOptions options;
            options.goal.cells = cells;
            const auto bytes = environment_file(t.target, options);
            acdf::File file;
            ASSERT_TRUE(acdf::File::from_memory(bytes.data(), bytes.size(), file, acdf::with_curves()).ok());
            const double variance = acdf::build::measure_environment(file, t.target).relative_variance;
            // Probabilities are rounded to what their curve stores.
            EXPECT_LE(variance, previous * 1.01 + 1e-6) << t.name << ", " << cells << " cells";
            previous = variance;
        }
    }
}

} // namespace
