// The fit of distributions that share cells: lib/compress/fit/shared.h.
#include "compress/fit/shared.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <random>

using namespace acdf::compress;

namespace {

/// Bumps at different points of a grid of squares of unequal measure.
struct Problem {
    SharedGrid grid;
    std::vector<SharedTarget> targets;

    explicit Problem(std::size_t bins, std::uint32_t rows = 24, std::uint32_t columns = 20) {
        for (std::uint32_t r = 0; r < rows; ++r) grid.row_measure.push_back(0.01 * (r + 1));
        for (std::uint32_t c = 0; c < columns; ++c) grid.column_measure.push_back(0.1 + 0.01 * (c % 3));
        for (std::size_t b = 0; b < bins; ++b) {
            SharedTarget target;
            target.weight = 1.0 + double(b);
            for (std::uint32_t r = 0; r < rows; ++r)
                for (std::uint32_t c = 0; c < columns; ++c) {
                    const double x = (double(c) - 3.0 - 2.0 * double(b)) / 2.0, y = (double(r) - 10.0) / 4.0;
                    target.square.push_back(static_cast<float>(std::exp(-x * x - y * y) + 1e-4));
                }
            targets.push_back(target);
        }
    }

    double cost(const TileTree& tree) const {
        double sum = 0.0;
        for (const SharedTarget& target : targets)
            for (const Box& box : tree.tiles) {
                double measure = 0.0, energy = 0.0;
                for (std::uint32_t r = box.begin[0]; r < box.end[0]; ++r)
                    for (std::uint32_t c = box.begin[1]; c < box.end[1]; ++c) {
                        const double m = grid.row_measure[r] * grid.column_measure[c];
                        measure += m;
                        energy += m * double{target.square[std::size_t{r} * grid.columns() + c]};
                    }
                sum += target.weight * std::sqrt(measure * energy);
            }
        return sum;
    }

    std::vector<double> moments(const TileTree& tree, std::size_t b) const {
        std::vector<double> energy(tree.tiles.size(), 0.0), measure(tree.tiles.size(), 0.0);
        const auto cell = cell_of_squares(grid, tree);
        for (std::size_t i = 0; i < cell.size(); ++i) {
            const double m = grid.row_measure[i / grid.columns()] * grid.column_measure[i % grid.columns()];
            measure[cell[i]] += m;
            energy[cell[i]] += m * double{targets[b].square[i]};
        }
        for (std::size_t c = 0; c < energy.size(); ++c) energy[c] *= measure[c];
        return energy;
    }
};

TEST(SharedPartition, coversTheGridOnceInPreorder) {
    const Problem problem(3);
    const SharedPartition partition(problem.grid, problem.targets, 100);
    for (const std::uint32_t cells : {2u, 17u, 80u}) {
        const TileTree tree = partition.pruned(cells);
        EXPECT_LE(tree.tiles.size(), cells);
        EXPECT_GE(tree.tiles.size() + 2, cells); // pruning takes whole divisions
        EXPECT_EQ(tree.splits.size() + 1, tree.tiles.size());
        std::size_t squares = 0;
        for (const Box& box : tree.tiles) squares += std::size_t{box.length(0)} * box.length(1);
        EXPECT_EQ(squares, problem.grid.size());
        std::uint32_t tiles = 0;
        for (std::size_t s = 0; s < tree.splits.size(); ++s) {
            const std::uint32_t lower = tree.splits[s].child[0];
            EXPECT_TRUE((lower & TileTree::tile) || lower == s + 1);
            for (const std::uint32_t child : tree.splits[s].child) tiles += child >> 31;
        }
        EXPECT_EQ(tiles, tree.tiles.size());
    }
}

TEST(SharedPartition, costsFarLessThanAnEvenOne) {
    const Problem problem(3);
    const SharedPartition partition(problem.grid, problem.targets, 100);
    TileTree even;
    for (std::uint32_t r = 0; r < 24; r += 4)
        for (std::uint32_t c = 0; c < 20; c += 2) {
            Box box;
            box.end.fill(1);
            box.begin[0] = r, box.end[0] = r + 4, box.begin[1] = c, box.end[1] = c + 2;
            even.tiles.push_back(box);
        }
    TileTree finest;
    for (std::uint32_t r = 0; r < 24; ++r)
        for (std::uint32_t c = 0; c < 20; ++c) {
            Box box;
            box.end.fill(1);
            box.begin[0] = r, box.end[0] = r + 1, box.begin[1] = c, box.end[1] = c + 1;
            finest.tiles.push_back(box);
        }
    const double least = problem.cost(finest), ours = problem.cost(partition.pruned(60));
    EXPECT_EQ(even.tiles.size(), 60u);
    EXPECT_LT(ours - least, 0.4 * (problem.cost(even) - least));
    double before = problem.cost(partition.pruned(1));
    for (const std::uint32_t cells : {4u, 16u, 64u}) {
        const double now = problem.cost(partition.pruned(cells));
        EXPECT_LT(now, before);
        before = now;
    }
}

TEST(SharedRows, optimumOfOneRowIsTheKnownOne) {
    const Problem problem(1);
    const TileTree tree = SharedPartition(problem.grid, problem.targets, 30).pruned(30);
    SharedMixture mix;
    mix.moment = problem.moments(tree, 0);
    mix.count = 1;
    mix.share[0] = 1.0;
    RowProbabilities rows(1, std::vector<double>(tree.tiles.size(), 1.0 / double(tree.tiles.size())));
    const double before = second_moment(rows, {mix});
    optimise_rows(rows, {mix}, 40);
    double sum = 0.0;
    for (const double m : mix.moment) sum += std::sqrt(m);
    EXPECT_NEAR(second_moment(rows, {mix}), sum * sum, 1e-9 * sum * sum); // (sum of costs)^2
    EXPECT_GT(before, 1.01 * sum * sum);
}

TEST(SharedRows, mixturesGetBetterWithEveryStep) {
    const Problem problem(4);
    const TileTree tree = SharedPartition(problem.grid, problem.targets, 40).pruned(40);
    std::vector<SharedMixture> mixtures(4);
    for (std::size_t m = 0; m < 4; ++m) { // two rows serve four distributions
        mixtures[m].moment = problem.moments(tree, m);
        mixtures[m].count = 2;
        mixtures[m].bin[1] = 1;
        mixtures[m].share[1] = double(m) / 3.0;
        mixtures[m].share[0] = 1.0 - mixtures[m].share[1];
    }
    RowProbabilities rows(2, std::vector<double>(tree.tiles.size(), 1.0 / double(tree.tiles.size())));
    double before = second_moment(rows, mixtures);
    for (int step = 0; step < 8; ++step) {
        optimise_rows(rows, mixtures, 1);
        const double now = second_moment(rows, mixtures);
        EXPECT_LE(now, before * (1.0 + 1e-12));
        before = now;
    }
    for (const auto& row : rows) EXPECT_NEAR(std::accumulate(row.begin(), row.end(), 0.0), 1.0, 1e-6);
}

TEST(SharedRows, whatMayBeNeededKeepsAProbability) {
    SharedMixture mix;
    mix.moment = {1.0, 0.0, 0.0};
    mix.count = 1;
    mix.share[0] = 1.0;
    RowProbabilities rows{{0.5, 0.5, 0.0}};
    optimise_rows(rows, {mix}, 50);
    EXPECT_NEAR(rows[0][1], 2e-4 / 3, 1e-7); // all of them together get no more than 2e-4
    EXPECT_EQ(rows[0][2], 0.0);
}

TEST(RowCodes, codebookRisesFrom0ToItsEnd) {
    const auto book = row_codebook();
    ASSERT_EQ(book.size(), 256u);
    EXPECT_EQ(book.front(), 0);
    EXPECT_EQ(book.back(), 65535);
    for (std::size_t i = 1; i < 256; ++i) EXPECT_LT(book[i - 1], book[i]);
}

TEST(RowCodes, areNearAndNeverLoseAnything) {
    const auto book = row_codebook();
    std::mt19937_64 random(3);
    std::uniform_real_distribution<double> u(-30.0, 30.0);
    for (int i = 0; i < 2000; ++i) {
        const double odds = std::exp(u(random)), p = odds / (1.0 + odds);
        const std::uint8_t code = row_code(odds, 1.0);
        EXPECT_GE(code, 1);
        EXPECT_LE(code, 254);
        const double error = p > 0.01 && p < 0.99 ? book[code] / 65535.0 - p : 0.0;
        EXPECT_LE(std::abs(error), 0.04 * std::min(p, 1.0 - p) + 0.001);
    }
    EXPECT_EQ(row_code(0.0, 1.0), 0);
    EXPECT_EQ(row_code(1.0, 0.0), 255);
    EXPECT_EQ(row_code(1e-30, 1.0), 1);
}

TEST(RowCodes, decodeToNearlyWhatWasEncoded) {
    const Problem problem(1);
    const TileTree tree = SharedPartition(problem.grid, problem.targets, 50).pruned(50);
    std::vector<double> row = problem.moments(tree, 0);
    for (double& p : row) p = std::sqrt(p);
    row[3] = 0.0;
    const double sum = std::accumulate(row.begin(), row.end(), 0.0);
    for (double& p : row) p /= sum;
    const auto codes = encode_row(tree, row);
    const auto back = decode_row(tree, row_codebook(), codes.data());
    EXPECT_NEAR(std::accumulate(back.begin(), back.end(), 0.0), 1.0, 1e-12);
    for (std::size_t c = 0; c < row.size(); ++c) {
        EXPECT_EQ(back[c] > 0.0, row[c] > 0.0);
        EXPECT_NEAR(back[c], row[c], 0.15 * row[c]);
    }
}

} // namespace
