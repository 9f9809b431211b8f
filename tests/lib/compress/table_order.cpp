// Trees of a table: what they are grown and put in order by.
#include "compress/tables/order.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

namespace {

using namespace acdf::compress;

/// Bins of 24 x 20 numbers: a spot in the middle of a dim bin, which neither one nor two halvings show, and waves.
struct SpotAndWaves {
    std::vector<float> values;
    std::vector<Grid> grids;

    SpotAndWaves() {
        constexpr std::uint32_t rows = 24, columns = 20;
        for (int bin = 0; bin < 2; ++bin)
            for (std::uint32_t r = 0; r < rows; ++r)
                for (std::uint32_t c = 0; c < columns; ++c) {
                    const bool spot = r >= 11 && r < 13 && c >= 9 && c < 11;
                    values.push_back(bin == 0 ? (spot ? 100.0f : 1.0f) : 2.0f + std::sin(0.9f * float(r * c)));
                }
        for (std::size_t bin = 0; bin < 2; ++bin)
            grids.push_back({{rows, columns},
                             {std::vector<double>(rows, 1.0 / rows), std::vector<double>(columns, 1.0 / columns)},
                             {0, 1},
                             values.data() + bin * rows * columns});
    }
};

TEST(TableOrder, HalvesFollowTheirParentAndEachIsThereOnce) {
    const SpotAndWaves bins;
    const TableCosts costs(bins.grids, 0.0);
    TableGrowth growth(costs);
    growth.run(200, -1.0, {});
    const TableOrder order(growth, costs.trees());
    const std::vector<TableNode>& nodes = order.nodes();
    ASSERT_EQ(nodes.size(), growth.nodes().size());
    EXPECT_EQ(order.leaves(), 200u);
    std::uint32_t next = 2;
    for (std::uint32_t i = 0; i < nodes.size(); ++i) {
        EXPECT_EQ(nodes[i].parent == i, i < 2);
        if (i >= 2) {
            EXPECT_EQ(nodes[nodes[i].parent].lower + i % 2, i);
        }
        if (nodes[i].lower != 0) ++next, ++next;
    }
    EXPECT_EQ(next, nodes.size());
}

TEST(TableOrder, NoPrefixIsWorseThanThatOfGrowth) {
    const SpotAndWaves bins;
    const TableCosts costs(bins.grids, 0.0);
    TableGrowth growth(costs);
    growth.run(300, -1.0, {});
    const TableOrder order(growth, costs.trees());
    ASSERT_EQ(order.leaves(), 300u);
    double before = order.variance(2);
    for (const std::size_t leaves : {10u, 30u, 60u, 100u, 200u, 300u}) {
        TableGrowth few(costs);
        few.run(leaves, -1.0, {});
        const TableOrder as_grown(few, costs.trees());
        EXPECT_LE(order.variance(leaves), as_grown.variance(leaves) + 1e-12) << leaves;
        EXPECT_LE(order.variance(leaves), before) << leaves;
        before = order.variance(leaves);
    }
}

// Each quarter of the spot takes some eight halvings, of which the first ones gain nothing.
TEST(TableOrder, ASpotInTheMiddleIsFound) {
    const SpotAndWaves bins;
    const std::vector<Grid> spot = {bins.grids[0]};
    const TableCosts costs(spot, 0.0);
    TableGrowth growth(costs);
    growth.run(60, -1.0, {});
    const TableOrder order(growth, 1);
    EXPECT_GT(order.variance(1), 10.0);
    EXPECT_LE(order.leaves(), 48u); // then nothing is left to gain
    EXPECT_LT(order.variance(order.leaves()), 1e-9);
}

TEST(TableCosts, BoxesOfThreeAxesAreSummedAsTheyAre) {
    const std::vector<std::uint32_t> shape = {5, 3, 7};
    std::vector<float> values;
    for (int i = 0; i < 105; ++i) values.push_back(static_cast<float>(i % 11));
    TableBox box;
    box.axis[0] = {1, 5};
    box.axis[1] = {0, 3};
    box.axis[2] = {2, 7};
    BoxSums sums;
    sum_box({shape, values.data(), true}, box, sums);
    const auto slow = [&](const TableBox& of) {
        double sum = 0.0;
        for (std::uint32_t a = of.axis[0].low; a < of.axis[0].high; ++a)
            for (std::uint32_t b = of.axis[1].low; b < of.axis[1].high; ++b)
                for (std::uint32_t c = of.axis[2].low; c < of.axis[2].high; ++c) {
                    const double value = static_cast<double>(values[(a * 3 + b) * 7 + c]);
                    sum += value * value;
                }
        return sum;
    };
    EXPECT_EQ(sums.all, slow(box)); // integers: exactly
    for (std::size_t a = 0; a < 3; ++a)
        for (std::uint32_t i = 0; i < 2; ++i) {
            const TableBox part = half(box, a, i);
            EXPECT_EQ(sums.of_half(a, i), slow(part)) << a << i;
            for (std::size_t b = 0; b < 3; ++b)
                for (std::uint32_t j = 0; j < 2; ++j) {
                    const double expected = slow(half(part, b, j));
                    EXPECT_EQ(b == a ? sums.quarter[a][2 * i + j] : sums.of_pair(a, i, b, j), expected) << a << b;
                }
        }
}

} // namespace
