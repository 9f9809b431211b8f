// No result depends on the order in which texels are added up.
#include "tests/extremes/targets.h"
#include "tests/inputs/environment_file.h"

#include "build/accuracy/environment.h"

#include <acdf/curves/curves.h>
#include <acdf/reader.h>
#include <acdf/views.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>

namespace {

using namespace acdf_test;
using acdf::compress::Target;

constexpr double kOrder = 1e-12;

/// The same lights on a sphere seen in a mirror, upside down: rows and columns in reverse order.
Target reversed(const Target& target) {
    Target out = target;
    std::reverse(out.values.begin(), out.values.end());
    std::reverse(out.row_measure.begin(), out.row_measure.end());
    return out;
}

/// Texels of a sky with many suns: terms that differ by 1e12, in numbers where naive sums lose digits.
Target many_suns(std::uint32_t columns, std::uint32_t rows) {
    std::mt19937_64 random(5);
    return texel_target(columns, rows, [&](std::uint32_t, std::uint32_t) {
        const double u = uniform(random);
        return u < 0.01 ? 1e6 * uniform(random) : 1e-6 * (1.0 + uniform(random));
    });
}

std::vector<NamedTarget> all_targets() {
    std::vector<NamedTarget> all = extreme_targets();
    for (NamedTarget& t : synthetic_targets()) all.push_back(std::move(t));
    for (NamedTarget& t : octahedral_extremes()) all.push_back(std::move(t));
    all.push_back({"many_suns", many_suns(512, 256)});
    return all;
}

TEST(Summation, IntegralsAreThoseOfAnyOrder) {
    std::mt19937_64 random(6);
    for (const NamedTarget& t : all_targets()) {
        std::vector<std::size_t> order(t.target.values.size());
        std::iota(order.begin(), order.end(), std::size_t{0});
        const double integral = acdf::compress::integral(t.target);
        for (int i = 0; i < 3; ++i) {
            std::shuffle(order.begin(), order.end(), random);
            long double sum = 0.0L;
            for (const std::size_t k : order)
                sum += static_cast<long double>(t.target.values[k]) *
                       static_cast<long double>(t.target.row_measure[k / t.target.columns]) *
                       static_cast<long double>(t.target.column_measure[k % t.target.columns]);
            EXPECT_NEAR(integral / static_cast<double>(sum), 1.0, kOrder) << t.name;
        }
        EXPECT_NEAR(acdf::compress::integral(reversed(t.target)) / integral, 1.0, kOrder) << t.name;
        EXPECT_NEAR(acdf::compress::integral(acdf::compress::transposed(t.target)) / integral, 1.0, kOrder)
            << t.name;
    }
}

// The figures of `measure`, by sums in extended precision over texels in a random order.
TEST(Summation, AccuracyIsThatOfAnyOrder) {
    std::mt19937_64 random(7);
    for (const NamedTarget& t : all_targets()) {
        acdf::compress::FitOptions options;
        options.goal.cells = 100;
        const auto bytes = environment_file(t.target, options);
        acdf::File file;
        ASSERT_TRUE(acdf::File::from_memory(bytes.data(), bytes.size(), file, acdf::with_curves()).ok());
        const auto accuracy = acdf::build::measure_environment(file, t.target);
        std::vector<std::size_t> order(t.target.values.size());
        std::iota(order.begin(), order.end(), std::size_t{0});
        std::shuffle(order.begin(), order.end(), random);
        const AcdfEnvironment env = file.environment().data();
        long double first = 0.0L, second = 0.0L;
        for (const std::size_t k : order) {
            const auto f = static_cast<long double>(t.target.values[k]);
            if (!(f > 0.0L)) continue;
            const std::uint32_t square[2] = {static_cast<std::uint32_t>(k % t.target.columns),
                                             static_cast<std::uint32_t>(k / t.target.columns)};
            AcdfRange range[2];
            AcdfStratum strata[2];
            const double p = acdf_environment_find_square(&env, square, range, strata);
            const AcdfGrid grid = acdf_environment_grid(&env);
            const double density = p / acdf_grid_solid_angle(&grid, range);
            const auto measure = static_cast<long double>(t.target.row_measure[square[1]]) *
                                 static_cast<long double>(t.target.column_measure[square[0]]);
            first += f * measure;
            second += f * f * measure / static_cast<long double>(density);
        }
        const long double moment = second / (first * first);
        EXPECT_NEAR(accuracy.total / static_cast<double>(first), 1.0, kOrder) << t.name;
        EXPECT_NEAR((1.0 + accuracy.relative_variance) / static_cast<double>(moment), 1.0, kOrder) << t.name;
    }
}

// A fit of the mirrored sphere is as good: sums of moments within it lose nothing either.
TEST(Summation, FitsAreAsGoodInAnyOrder) {
    for (const NamedTarget& t : all_targets()) {
        acdf::compress::FitOptions options;
        options.goal.cells = 240;
        double variance[2];
        for (int i = 0; i < 2; ++i) {
            const Target target = i == 0 ? t.target : reversed(t.target);
            const auto bytes = environment_file(target, options);
            acdf::File file;
            ASSERT_TRUE(acdf::File::from_memory(bytes.data(), bytes.size(), file, acdf::with_curves()).ok());
            variance[i] = acdf::build::measure_environment(file, target).relative_variance;
        }
        // Ties are resolved from the left, so that the fits are not mirror images; none may be much worse.
        EXPECT_NEAR((1.0 + variance[0]) / (1.0 + variance[1]), 1.0, 0.05) << t.name;
    }
}

} // namespace
