// Rows of probabilities that mixtures are sampled from: lib/compress/brdf/row_mixtures.h.
#include "compress/brdf/row_mixtures.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstddef>
#include <numeric>
#include <vector>

using namespace acdf::compress;

namespace {

constexpr std::size_t kCells = 40;

/// A bump over the cells, at a place of its own for each number.
std::vector<double> bump(std::size_t number) {
    std::vector<double> out;
    for (std::size_t c = 0; c < kCells; ++c) {
        const double x = (double(c) - 3.0 - 6.0 * double(number)) / 4.0;
        out.push_back(std::exp(-x * x) + 1e-4);
    }
    return out;
}

RowProbabilities even(std::size_t rows) {
    return RowProbabilities(rows, std::vector<double>(kCells, 1.0 / double(kCells)));
}

TEST(RowMixtures, OptimumOfOneRowIsTheKnownOne) {
    SharedMixture mix;
    mix.moment = bump(0);
    mix.count = 1;
    mix.share[0] = 1.0;
    RowProbabilities rows = even(1);
    const double before = second_moment(rows, {mix});
    optimise_rows(rows, {mix}, 40);
    double sum = 0.0;
    for (const double m : mix.moment) sum += std::sqrt(m);
    EXPECT_NEAR(second_moment(rows, {mix}), sum * sum, 1e-9 * sum * sum); // (sum of costs)^2
    EXPECT_GT(before, 1.01 * sum * sum);
}

TEST(RowMixtures, GetBetterWithEveryStep) {
    std::vector<SharedMixture> mixtures(4);
    for (std::size_t m = 0; m < 4; ++m) { // two rows serve four distributions
        mixtures[m].moment = bump(m);
        mixtures[m].count = 2;
        mixtures[m].bin[1] = 1;
        mixtures[m].share[1] = double(m) / 3.0;
        mixtures[m].share[0] = 1.0 - mixtures[m].share[1];
    }
    RowProbabilities rows = even(2);
    double before = second_moment(rows, mixtures);
    for (int step = 0; step < 8; ++step) {
        optimise_rows(rows, mixtures, 1);
        const double now = second_moment(rows, mixtures);
        EXPECT_LE(now, before * (1.0 + 1e-12));
        before = now;
    }
    for (const auto& row : rows) EXPECT_NEAR(std::accumulate(row.begin(), row.end(), 0.0), 1.0, 1e-6);
}

TEST(RowMixtures, WhatMayBeNeededKeepsAProbability) {
    SharedMixture mix;
    mix.moment = {1.0, 0.0, 0.0};
    mix.count = 1;
    mix.share[0] = 1.0;
    RowProbabilities rows{{0.5, 0.5, 0.0}};
    optimise_rows(rows, {mix}, 50);
    EXPECT_NEAR(rows[0][1], 2e-4 / 3, 1e-7); // all of them together get no more than 2e-4
    EXPECT_EQ(rows[0][2], 0.0);
}

} // namespace
