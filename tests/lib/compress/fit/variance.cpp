// The variance fit: cells, probabilities, and the closed form of its relative variance; the cascade of two levels
// against a slow reference. What is particular to trees is in compress_tree.cpp.
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

FitOptions variance_options(std::uint32_t cells, Shape shape = Shape::cascade, Order order = Order::z) {
    FitOptions options;
    options.fit = ACDF_FIT_VARIANCE;
    options.goal.cells = cells;
    options.shape = shape;
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

/// Rows, all columns apart: what a band costs before its columns are joined.
double band_cost(const Target& t, Run rows) {
    double sum = 0.0;
    for (std::uint32_t c = 0; c < t.columns; ++c) sum += cell_cost(t, rows, {c, c + 1});
    return sum;
}

/// Joins the neighbours that raise the cost least until `count` runs are left.
template <class Cost>
void join_down(std::vector<Run>& runs, std::size_t count, const Cost& cost) {
    while (runs.size() > count) {
        std::size_t best = 0;
        double least = INFINITY;
        for (std::size_t k = 0; k + 1 < runs.size(); ++k) {
            const double raise = cost(Run{runs[k].first, runs[k + 1].second}) - cost(runs[k]) - cost(runs[k + 1]);
            if (raise < least) least = raise, best = k;
        }
        runs[best].second = runs[best + 1].second;
        runs.erase(runs.begin() + static_cast<std::ptrdiff_t>(best) + 1);
    }
}

struct Partition {
    std::vector<std::pair<Run, Run>> cells; // rows, columns
    double cost = 0.0;
};

/// All cells of all bands, joined along columns, the cheapest anywhere first.
Partition slow_columns(const Target& t, const std::vector<Run>& bands, std::size_t count) {
    Partition p;
    for (const Run& band : bands)
        for (std::uint32_t c = 0; c < t.columns; ++c) p.cells.push_back({band, {c, c + 1}});
    while (p.cells.size() > count) {
        std::size_t best = 0;
        double least = INFINITY;
        for (std::size_t k = 0; k + 1 < p.cells.size(); ++k) {
            const auto& [rows, a] = p.cells[k];
            const auto& [next_rows, b] = p.cells[k + 1];
            if (rows != next_rows) continue;
            const double raise =
                cell_cost(t, rows, {a.first, b.second}) - cell_cost(t, rows, a) - cell_cost(t, rows, b);
            if (raise < least) least = raise, best = k;
        }
        p.cells[best].second.second = p.cells[best + 1].second.second;
        p.cells.erase(p.cells.begin() + static_cast<std::ptrdiff_t>(best) + 1);
    }
    for (const auto& [rows, columns] : p.cells) p.cost += cell_cost(t, rows, columns);
    return p;
}

/// Band counts 4, 4 sqrt 2, 8, ...: the cheapest partition of any.
Partition slow_variance(const Target& t, std::size_t count) {
    Partition best;
    best.cost = INFINITY;
    std::vector<std::size_t> counts;
    for (double bands = 4.0; bands <= t.rows && bands <= double(count) / 2; bands *= std::sqrt(2.0))
        counts.push_back(static_cast<std::size_t>(bands));
    for (const std::size_t bands : counts) {
        std::vector<Run> rows;
        for (std::uint32_t r = 0; r < t.rows; ++r) rows.push_back({r, r + 1});
        join_down(rows, bands, [&](Run run) { return band_cost(t, run); });
        Partition p = slow_columns(t, rows, count);
        if (p.cost < best.cost) best = std::move(p);
    }
    return best;
}

TEST(FitVariance, CascadeJoinsWhatTheSlowReferenceJoins) {
    for (std::uint64_t seed = 1; seed <= 6; ++seed) {
        SCOPED_TRACE(seed);
        const Target t = acdf_test::noise_target(13, 11, seed, 1.0);
        const std::size_t count = 10 + 7 * seed;
        const auto cells =
            cells_of(fit_variance_cascade(t, variance_options(static_cast<std::uint32_t>(count))), t);
        const Partition expected = slow_variance(t, count);
        ASSERT_EQ(cells.size(), expected.cells.size());
        EXPECT_NEAR(acdf_test::cost_sum(cells, t) / expected.cost, 1.0, 1e-12);
        for (std::size_t i = 0; i < cells.size(); ++i) {
            const auto& [rows, columns] = expected.cells[i];
            EXPECT_EQ(std::make_pair(cells[i].low[1], cells[i].high[1]), rows);
            EXPECT_EQ(std::make_pair(cells[i].low[0], cells[i].high[0]), columns);
        }
    }
}

TEST(FitVariance, RefusesAGoalOfNoCells) {
    const Target t = acdf_test::noise_target(8, 4, 2);
    EXPECT_THROW(fit(t, variance_options(0)), std::invalid_argument);
    EXPECT_THROW(fit(t, variance_options(0, Shape::tree)), std::invalid_argument);
}

TEST(FitVariance, ProgressRisesAndEndsAtOne) {
    const Target t = acdf_test::noise_target(64, 40, 2);
    for (const Shape shape : {Shape::cascade, Shape::tree}) {
        FitOptions options = variance_options(200, shape);
        double last = 0.0;
        options.progress = [&](double share) {
            EXPECT_GE(share, last);
            last = share;
        };
        fit(t, options);
        EXPECT_EQ(last, 1.0);
    }
}

TEST(FitVariance, CascadeKeepsTheBudgetAndUsesIt) {
    const Target t = acdf_test::noise_target(64, 40, 2);
    double before = INFINITY;
    for (const std::uint32_t budget : {1u, 2u, 3u, 7u, 8u, 50u, 333u, 1000u, 2560u, 100000u}) {
        SCOPED_TRACE(budget);
        const auto cells = cells_of(fit_variance_cascade(t, variance_options(budget)), t);
        EXPECT_LE(cells.size(), budget);
        EXPECT_GE(cells.size(), std::min<std::size_t>(budget, 64 * 32)); // band counts come in steps of sqrt(2)
        const double cost = acdf_test::cost_sum(cells, t);
        EXPECT_LE(cost, before * (1.0 + 1e-12));
        before = cost;
    }
}

// ---- what holds of either shape -------------------------------------------------------------------------

class VarianceOf : public ::testing::TestWithParam<std::tuple<Shape, Order>> {
protected:
    FitOptions options(std::uint32_t cells) const {
        return variance_options(cells, std::get<0>(GetParam()), std::get<1>(GetParam()));
    }
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

INSTANTIATE_TEST_SUITE_P(ShapesAndOrders, VarianceOf,
                         ::testing::Combine(::testing::Values(Shape::cascade, Shape::tree),
                                            ::testing::Values(Order::phi, Order::z)),
                         [](const auto& info) {
                             const std::string shape = std::get<0>(info.param) == Shape::tree ? "tree" : "cascade";
                             return shape + (std::get<1>(info.param) == Order::phi ? "_phi" : "_z");
                         });

} // namespace
