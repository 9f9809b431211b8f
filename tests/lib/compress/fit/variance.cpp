// The variance fit of trees whose borders lie anywhere: cells, probabilities, and the closed form of its relative
// variance.
#include "tests/inputs/synthetic.h"
#include "tests/lib/compress/cascade_cells.h"

#include "build/accuracy/cells.h"
#include "build/accuracy/environment.h"
#include "compress/fit/fit.h"
#include "compress/store/store.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <tuple>

namespace {

using namespace acdf::compress;
using acdf_test::CascadeCell;
using acdf_test::cells_of;

FitOptions variance_options(std::uint32_t cells, Order order = Order::z) {
    FitOptions options;
    options.fit = ACDF_FIT_VARIANCE;
    options.goal.cells = cells;
    options.order = order;
    return options;
}

// ---- a slow reference -----------------------------------------------------------------------------------

using Run = std::pair<std::uint32_t, std::uint32_t>; // [begin, end)

/// Integral of f^2 over rows x columns times the measure, square root: C of that cell.
double cell_cost(const Target& t, Run rows, Run columns) {
    const CascadeCell cell = {{columns.first, rows.first}, {columns.second, rows.second}};
    const auto sums = acdf_test::cell_sums(cell, t);
    return static_cast<double>(std::sqrt(sums.measure * sums.square));
}

TEST(FitVariance, RefusesAGoalOfNoCells) {
    const Target t = acdf_test::noise_target(8, 4, 2);
    EXPECT_THROW(fit(t, variance_options(0)), std::invalid_argument);
}

TEST(FitVariance, ProgressRisesAndEndsAtOne) {
    const Target t = acdf_test::noise_target(64, 40, 2);
    FitOptions options = variance_options(200);
    double last = 0.0;
    options.progress = [&](double share) {
        EXPECT_GE(share, last);
        last = share;
    };
    fit(t, options);
    EXPECT_EQ(last, 1.0);
}

// ---- what holds of both orders --------------------------------------------------------------------------

class VarianceOf : public ::testing::TestWithParam<Order> {
protected:
    FitOptions options(std::uint32_t cells) const { return variance_options(cells, GetParam()); }
    std::vector<CascadeCell> cells(const Target& t, std::uint32_t count) const {
        return cells_of(fit(t, options(count)).cascade, t);
    }
};

TEST_P(VarianceOf, ProbabilitiesAreSharesOfTheCost) {
    const Target t = acdf_test::noise_target(40, 25, 9, 2.0, 0.2);
    const auto all = cells(t, 150);
    const double total = acdf_test::cost_sum(all, t);
    for (const CascadeCell& cell : all)
        EXPECT_NEAR(cell.probability,
                    cell_cost(t, {cell.low[1], cell.high[1]}, {cell.low[0], cell.high[0]}) / total, 1e-13);
}

/// Relative variance of a stored tree: as measured, and from C of each of its cells.
struct Variances {
    double measured, summed;
};

Variances stored_variances(const EncodedTree& tree, const std::vector<CascadeCell>& cells, const Target& t) {
    const auto bytes = store(tree, environment_description(t.columns, t.rows));
    acdf::File file;
    const acdf::Status status = acdf::File::from_memory(bytes.data(), bytes.size(), file);
    if (!status.ok()) throw std::runtime_error(status.message);
    double second = 0.0;
    std::size_t i = 0;
    acdf::build::for_each_cell(file, file.bin(0).root, [&](const acdf::build::Cell& stored) {
        const CascadeCell& cell = cells.at(i++);
        EXPECT_EQ(stored.range[0].low, cell.low[0]);
        EXPECT_EQ(stored.range[1].high, cell.high[1]);
        const double cost = cell_cost(t, {cell.low[1], cell.high[1]}, {cell.low[0], cell.high[0]});
        if (cost > 0.0) second += cost * cost / stored.probability;
    });
    EXPECT_EQ(i, cells.size());
    return {acdf::build::measure_environment(file, t).relative_variance, second / std::pow(integral(t), 2) - 1.0};
}

TEST_P(VarianceOf, MeasuredRelativeVarianceIsTheClosedForm) {
    for (const auto& [name, t] : acdf_test::synthetic_targets()) {
        SCOPED_TRACE(name);
        const Fitted fitted = fit(t, options(120));
        const auto all = cells_of(fitted.cascade, t);
        const double second =
            std::pow(acdf_test::cost_sum(all, t) / integral(t), 2); // E[(f/p)^2] / (integral of f)^2
        EXPECT_NEAR(acdf_test::brute_relative_variance(all, t), second - 1.0, 1e-9 * second);
        const Variances stored = stored_variances(fitted.tree, all, t);
        EXPECT_NEAR(stored.measured, stored.summed, 1e-9 * second);
        // With 32 bits, rounding the probabilities adds next to nothing; at a price, at most what the bytes of
        // 32-bit values would have cost.
        EXPECT_NEAR(stored_variances(encode_tree(fitted.cascade, 0.0), all, t).measured, second - 1.0,
                    1e-6 * second);
        const double price = 1e-8, dearest = price * 4.0 * static_cast<double>(all.size());
        EXPECT_LE(stored_variances(encode_tree(fitted.cascade, price), all, t).measured,
                  second * (1.0 + 2.0 * dearest + 1e-6) - 1.0);
    }
}

TEST_P(VarianceOf, NoOtherProbabilitiesDoBetter) {
    const Target t = acdf_test::noise_target(24, 16, 4, 1.5);
    const auto all = cells(t, 60);
    const double best = acdf_test::brute_relative_variance(all, t);
    std::mt19937_64 random(7);
    for (int trial = 0; trial < 20; ++trial) {
        auto moved = all;
        const std::size_t a = random() % all.size(), b = random() % all.size();
        const double step = 0.1 * std::min(all[a].probability, all[b].probability);
        if (a == b) continue;
        moved[a].probability += step;
        moved[b].probability -= step;
        EXPECT_GT(acdf_test::brute_relative_variance(moved, t), best);
    }
}

TEST_P(VarianceOf, KeepsTheBudgetOfCells) {
    const Target t = acdf_test::noise_target(64, 40, 2);
    for (const std::uint32_t budget : {1u, 2u, 3u, 7u, 8u, 50u, 333u, 1000u, 2560u, 100000u})
        EXPECT_LE(cells(t, budget).size(), budget);
}

TEST_P(VarianceOf, CostsLessThanThePaperFitWithAsManyCells) {
    const Target t = acdf_test::noise_target(96, 64, 3, 1.0);
    FitOptions paper;
    paper.fit = ACDF_FIT_CDF;
    paper.column_segments = paper.row_segments = 16;
    const auto theirs = cells_of(fit(t, paper).cascade, t);
    const auto ours = cells(t, static_cast<std::uint32_t>(theirs.size()));
    EXPECT_LT(acdf_test::brute_relative_variance(ours, t), acdf_test::brute_relative_variance(theirs, t));
}

TEST_P(VarianceOf, ReportsProgressInOrder) {
    const Target t = acdf_test::noise_target(64, 40, 2);
    FitOptions with_progress = options(500);
    std::vector<double> shares;
    with_progress.progress = [&](double share) { shares.push_back(share); };
    fit(t, with_progress);
    ASSERT_FALSE(shares.empty());
    EXPECT_TRUE(std::is_sorted(shares.begin(), shares.end()));
    EXPECT_GE(shares.front(), 0.0);
    EXPECT_LE(shares.back(), 1.0);
}

INSTANTIATE_TEST_SUITE_P(Orders, VarianceOf, ::testing::Values(Order::phi, Order::z),
                         [](const auto& info) { return info.param == Order::phi ? "phi" : "z"; });

} // namespace
