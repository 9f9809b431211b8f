// fit_variance: cells, probabilities, and the closed form of its relative variance.
#include "compress_cascade_cells.h"
#include "synthetic.h"

#include "compress/fit.h"
#include "compress/store.h"
#include "measure/accuracy.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace {

using namespace acdf::compress;
using acdf_test::CascadeCell;
using acdf_test::cells_of;

FitOptions variance(std::uint32_t cells, Order order = Order::z) {
    FitOptions options;
    options.fit = ACDF_FIT_VARIANCE;
    options.cells = cells;
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
    for (double bands = 4.0; bands <= t.rows && bands <= double(count) / 2; bands *= std::sqrt(2.0)) {
        std::vector<Run> rows;
        for (std::uint32_t r = 0; r < t.rows; ++r) rows.push_back({r, r + 1});
        join_down(rows, static_cast<std::size_t>(bands), [&](Run run) { return band_cost(t, run); });
        Partition p = slow_columns(t, rows, count);
        if (p.cost < best.cost) best = std::move(p);
    }
    return best;
}

TEST(FitVariance, JoinsWhatTheSlowReferenceJoins) {
    for (std::uint64_t seed = 1; seed <= 6; ++seed) {
        SCOPED_TRACE(seed);
        const Target t = acdf_test::noise_target(13, 11, seed, 1.0);
        const std::size_t count = 10 + 7 * seed;
        const auto cells = cells_of(fit_variance(t, variance(static_cast<std::uint32_t>(count))), t);
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

// ---- the closed form ------------------------------------------------------------------------------------

double measured(const Cascade& cascade, const Target& t, double tolerance) {
    const auto bytes = store(encode_tree(cascade, tolerance), environment_description(t.columns, t.rows));
    acdf::File file;
    const acdf::Status status = acdf::File::from_memory(bytes.data(), bytes.size(), file);
    EXPECT_TRUE(status.ok()) << status.message;
    return status.ok() ? acdf::measure::measure_environment(file, t).relative_variance : INFINITY;
}

TEST(FitVariance, ProbabilitiesAreSharesOfTheCost) {
    const Target t = acdf_test::noise_target(40, 25, 9, 2.0, 0.2);
    for (const Order order : {Order::phi, Order::z}) {
        const auto cells = cells_of(fit(t, variance(150, order)), t);
        const double total = acdf_test::cost_sum(cells, t);
        for (const CascadeCell& cell : cells)
            EXPECT_NEAR(cell.probability,
                        cell_cost(t, {cell.low[1], cell.high[1]}, {cell.low[0], cell.high[0]}) / total, 1e-13);
    }
}

TEST(FitVariance, MeasuredRelativeVarianceIsTheClosedForm) {
    for (const auto& [name, t] : acdf_test::synthetic_targets()) {
        SCOPED_TRACE(name);
        for (const Order order : {Order::phi, Order::z}) {
            const Cascade cascade = fit(t, variance(120, order));
            const auto cells = cells_of(cascade, t);
            const double cost = acdf_test::cost_sum(cells, t);
            const double closed = std::pow(cost / integral(t), 2) - 1.0;
            EXPECT_NEAR(acdf_test::brute_relative_variance(cells, t), closed, 1e-9 * (1.0 + closed));
            // Quantizing adds at most the tolerance for every curve.
            const double added = measured(cascade, t, 2e-6) - closed;
            EXPECT_GE(added, -1e-9);
            EXPECT_LE(added, 2e-6 * double(cascade.curves.size()) * (1.0 + closed) + 1e-9);
            EXPECT_NEAR(measured(cascade, t, 0.0), closed, 1e-6 * (1.0 + closed)); // all curves wide
        }
    }
}

TEST(FitVariance, NoOtherProbabilitiesDoBetter) {
    const Target t = acdf_test::noise_target(24, 16, 4, 1.5);
    const auto cells = cells_of(fit(t, variance(60)), t);
    const double best = acdf_test::brute_relative_variance(cells, t);
    std::mt19937_64 random(7);
    for (int trial = 0; trial < 20; ++trial) {
        auto moved = cells;
        const std::size_t a = random() % cells.size(), b = random() % cells.size();
        const double step = 0.1 * std::min(cells[a].probability, cells[b].probability);
        if (a == b) continue;
        moved[a].probability += step;
        moved[b].probability -= step;
        EXPECT_GT(acdf_test::brute_relative_variance(moved, t), best);
    }
}

TEST(FitVariance, KeepsTheBudgetAndUsesIt) {
    const Target t = acdf_test::noise_target(64, 40, 2);
    double before = INFINITY;
    for (const std::uint32_t budget : {1u, 2u, 3u, 7u, 8u, 50u, 333u, 1000u, 2560u, 100000u}) {
        SCOPED_TRACE(budget);
        EXPECT_LE(cells_of(fit(t, variance(budget)), t).size(), budget);
        const auto cells = cells_of(fit_variance(t, variance(budget)), t);
        EXPECT_EQ(cells.size(), std::min<std::size_t>(budget, 64 * 32)); // band counts come in steps of sqrt(2)
        const double cost = acdf_test::cost_sum(cells, t);
        EXPECT_LE(cost, before * (1.0 + 1e-12));
        before = cost;
    }
}

TEST(FitVariance, CostsLessThanThePaperFitWithAsManyCells) {
    const Target t = acdf_test::noise_target(96, 64, 3, 1.0);
    FitOptions paper;
    paper.fit = ACDF_FIT_CDF;
    paper.column_segments = paper.row_segments = 16;
    const auto theirs = cells_of(fit(t, paper), t);
    const auto ours = cells_of(fit(t, variance(static_cast<std::uint32_t>(theirs.size()))), t);
    EXPECT_LT(acdf_test::brute_relative_variance(ours, t), acdf_test::brute_relative_variance(theirs, t));
}

TEST(FitVariance, ReportsProgressInOrder) {
    const Target t = acdf_test::noise_target(64, 40, 2);
    FitOptions options = variance(500);
    std::vector<double> shares;
    options.progress = [&](double share) { shares.push_back(share); };
    fit(t, options);
    ASSERT_FALSE(shares.empty());
    EXPECT_TRUE(std::is_sorted(shares.begin(), shares.end()));
    EXPECT_GE(shares.front(), 0.0);
    EXPECT_EQ(shares.back(), 1.0);
}

} // namespace
