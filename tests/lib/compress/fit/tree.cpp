// Trees of the variance fit: what the goals promise.
#include "tests/inputs/synthetic.h"
#include "tests/lib/compress/cascade_cells.h"

#include "build/accuracy/environment.h"
#include "compress/fit/fit.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace {

using namespace acdf::compress;

FitOptions tree_for(const Goal& goal) {
    FitOptions options;
    options.fit = ACDF_FIT_VARIANCE;
    options.goal = goal;
    return options;
}

Goal cells(std::uint32_t count) { return {Goal::Kind::cells, count, 0, 0.0}; }
Goal budget(std::uint64_t bytes) { return {Goal::Kind::budget, 0, bytes, 0.0}; }
Goal variance(double most) { return {Goal::Kind::variance, 0, 0, most}; }

std::vector<std::uint8_t> file_of(const EncodedTree& tree, const Target& t) {
    return store(tree, environment_description(t.columns, t.rows));
}

double measured(const EncodedTree& tree, const Target& t) {
    const auto bytes = file_of(tree, t);
    acdf::File file;
    const acdf::Status status = acdf::File::from_memory(bytes.data(), bytes.size(), file);
    EXPECT_TRUE(status.ok()) << status.message;
    return status.ok() ? acdf::build::measure_environment(file, t).relative_variance : INFINITY;
}

/// Small lights at different heights and azimuths over a smooth sky: what two levels cannot separate.
Target many_lights() {
    const Target sky = acdf_test::sphere_target(128, 64, acdf_test::smooth_sky);
    return acdf_test::texel_target(128, 64, [&](std::uint32_t c, std::uint32_t r) {
        return (c * 37 + r * 101) % 127 == 0 ? 50.0 : double{sky.row(r)[c]};
    });
}

TEST(FitTree, UsesTheCellsItMayHave) {
    const Target t = acdf_test::noise_target(64, 40, 2);
    double before = INFINITY;
    for (const std::uint32_t count : {1u, 2u, 16u, 100u, 777u}) {
        SCOPED_TRACE(count);
        const Fitted fitted = fit(t, tree_for(cells(count)));
        const auto all = acdf_test::cells_of(fitted.cascade, t);
        EXPECT_LE(all.size(), count);
        if (count >= 16) { // a split into many comes all at once
            EXPECT_GE(all.size(), count - count / 4);
        }
        const double cost = acdf_test::cost_sum(all, t);
        EXPECT_LE(cost, before);
        before = cost;
    }
}

TEST(FitTree, HasNoVarianceWithACellATexel) {
    const Target t = acdf_test::noise_target(24, 13, 2);
    const Fitted fitted = fit(t, tree_for(cells(1000000)));
    EXPECT_NEAR(acdf_test::brute_relative_variance(acdf_test::cells_of(fitted.cascade, t), t), 0.0, 1e-6);
}

TEST(FitTree, SeesFarBelowWhatASunGains) {
    // The sun's division gains ten thousand times what any division of the sky does.
    const Target sky = acdf_test::sphere_target(96, 48, acdf_test::smooth_sky);
    const Target t = acdf_test::texel_target(
        96, 48, [&](std::uint32_t c, std::uint32_t r) { return c == 29 && r == 11 ? 1e5 : double{sky.row(r)[c]}; });
    const Fitted fitted = fit(t, tree_for(cells(500)));
    EXPECT_GE(acdf_test::cells_of(fitted.cascade, t).size(), 375u);
    const double reached = measured(fit(t, tree_for(variance(1e-4))).tree, t);
    EXPECT_LE(reached, 1e-4 * (1.0 + 1e-9));
}

TEST(FitTree, KeepsABudgetOfBytes) {
    const Target t = acdf_test::noise_target(96, 64, 3, 1.0);
    double before = INFINITY;
    for (const std::uint64_t bytes : {64u, 500u, 2000u, 8000u}) {
        SCOPED_TRACE(bytes);
        const Fitted fitted = fit(t, tree_for(budget(bytes)));
        EXPECT_LE(fitted.tree.bytes.size(), bytes);
        EXPECT_GE(static_cast<double>(fitted.tree.bytes.size()), 0.75 * static_cast<double>(bytes));
        const double relative_variance = measured(fitted.tree, t);
        EXPECT_LT(relative_variance, before);
        before = relative_variance;
    }
}

TEST(FitTree, KeepsABudgetOfTheWholeFile) {
    const Target t = acdf_test::noise_target(96, 64, 3, 1.0);
    FitOptions options = tree_for(budget(4096));
    options.file_size = [&](const EncodedTree& tree) { return file_of(tree, t).size(); };
    const std::size_t size = file_of(fit(t, options).tree, t).size();
    EXPECT_LE(size, 4096u);
    EXPECT_GE(size, 3072u);
}

TEST(FitTree, ABudgetForEverythingHoldsEverything) {
    const Target t = acdf_test::noise_target(24, 13, 2);
    EXPECT_LT(measured(fit(t, tree_for(budget(1 << 20))).tree, t), 1e-6);
}

TEST(FitTree, RefusesABudgetBelowTheSmallestFile) {
    const Target t = acdf_test::noise_target(24, 13, 2);
    EXPECT_THROW(fit(t, tree_for(budget(1))), std::runtime_error);
    FitOptions options = tree_for(budget(100));
    options.file_size = [&](const EncodedTree& tree) { return file_of(tree, t).size(); };
    EXPECT_THROW(fit(t, options), std::runtime_error);
}

TEST(FitTree, ReachesATargetVarianceWithFewBytes) {
    for (const Target& t : {acdf_test::noise_target(96, 64, 3, 1.0), many_lights()}) {
        std::size_t before = 0;
        for (const double goal : {0.5, 0.1, 0.02, 0.004}) {
            SCOPED_TRACE(goal);
            const Fitted fitted = fit(t, tree_for(variance(goal)));
            EXPECT_LE(measured(fitted.tree, t), goal * (1.0 + 1e-9));
            EXPECT_GE(fitted.tree.bytes.size(), before);
            before = fitted.tree.bytes.size();
            if (before < 100) continue;
            // With a tenth less it cannot be had.
            EXPECT_GT(measured(fit(t, tree_for(budget(before - before / 10))).tree, t), goal);
        }
    }
}

TEST(FitTree, KeepsWeightsBelowTheirBound) {
    const Target t = acdf_test::noise_target(96, 64, 3, 1.0);
    for (const Goal& goal : {cells(2000), budget(8000)}) {
        FitOptions options = tree_for(goal);
        const auto bytes = file_of(fit(t, options).tree, t);
        options.max_weight = 3.0;
        const auto bounded = file_of(fit(t, options).tree, t);
        acdf::File file, bounded_file;
        ASSERT_TRUE(acdf::File::from_memory(bytes.data(), bytes.size(), file).ok());
        ASSERT_TRUE(acdf::File::from_memory(bounded.data(), bounded.size(), bounded_file).ok());
        EXPECT_GT(acdf::build::measure_environment(file, t).max_weight, 3.0); // else the bound would do nothing
        EXPECT_LE(acdf::build::measure_environment(bounded_file, t).max_weight, 3.0 * (1.0 + 1e-6));
    }
}

TEST(FitTree, RefusesATargetVarianceOutOfReach) {
    const Target t = acdf_test::noise_target(24, 13, 2);
    EXPECT_THROW(fit(t, tree_for(variance(-1.0))), std::runtime_error);
}

TEST(FitTree, OneCellIsEnoughForAConstant) {
    const Target t = acdf_test::sphere_target(50, 25, [](double, double) { return 0.25; });
    for (const Goal& goal : {cells(4096), budget(100000), variance(1e-6)})
        EXPECT_EQ(acdf_test::cells_of(fit(t, tree_for(goal)).cascade, t).size(), 1u);
}

TEST(FitTree, SpendsNothingOnDarkness) {
    const Target t = acdf_test::texel_target(64, 32, [](std::uint32_t c, std::uint32_t r) {
        return c >= 20 && c < 24 && r >= 9 && r < 13 ? 1.0 + 0.1 * c * r : 0.0;
    });
    std::size_t dark = 0;
    const Fitted fitted = fit(t, tree_for(cells(24)));
    for (const auto& cell : acdf_test::cells_of(fitted.cascade, t)) {
        const bool lit = acdf_test::cell_sums(cell, t).f > 0.0L;
        EXPECT_EQ(cell.probability > 0.0, lit);
        dark += !lit;
        const bool inside = cell.low[0] >= 20 && cell.high[0] <= 24 && cell.low[1] >= 9 && cell.high[1] <= 13;
        EXPECT_TRUE(inside || !lit);
    }
    EXPECT_LE(dark, 4u);
}

TEST(FitTree, SameBytesForEveryGoalTwice) {
    const Target t = many_lights();
    for (const Goal& goal : {cells(300), budget(900), variance(0.05)})
        EXPECT_EQ(fit(t, tree_for(goal)).tree.bytes, fit(t, tree_for(goal)).tree.bytes);
}

} // namespace
