// Codes of rows leave random numbers to every tile that has light, however coarse they are.
#include "compress/halvings/rows.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

namespace acdf::compress {
namespace {

TEST(HalvingCodes, LeastStepsAreEnoughForBothHalves) {
    std::mt19937 random(5);
    for (const std::uint32_t bits : {4u, 6u, 8u}) {
        const HalvingCodes codes(bits);
        for (int i = 0; i < 20000; ++i) {
            const auto some = [&] { return std::ceil(std::exp2(7.0 + double(random() % 1500) / 100.0)); };
            const double a = some(), b = some(), light = std::exp2(double(random() % 80) - 40.0);
            const auto wide = static_cast<std::uint32_t>(std::min(std::ceil(codes.least(a, b)), 0x1p31));
            const std::uint32_t lower = codes.lower(wide, codes.best(wide, light, 1.0, a, b));
            ASSERT_GE(lower, a) << bits << ": " << a << ", " << b;
            ASSERT_GE(wide - lower, b) << bits << ": " << a << ", " << b;
        }
    }
}

/// A tree that halves its lower half again and again, so that tiles differ by factors.
std::vector<HalvedNode> comb(std::size_t halvings) {
    std::vector<HalvedNode> nodes(2 * halvings + 1);
    for (std::size_t i = 0; i < halvings; ++i) {
        const std::size_t node = i == 0 ? 0 : 2 * i - 1;
        nodes[node].axis = static_cast<std::int8_t>(i % 2);
        nodes[node].lower = static_cast<std::uint32_t>(2 * i + 1);
    }
    return nodes;
}

TEST(RowTree, EveryTileWithLightIsReached) {
    const std::size_t halvings = 18;
    const std::vector<HalvedNode> nodes = comb(halvings);
    std::vector<double> weights(nodes.size());
    for (std::size_t i = nodes.size(); i-- > 0;)
        weights[i] = nodes[i].lower ? weights[nodes[i].lower] + weights[nodes[i].lower + 1] : 1.0;
    const RowTree tree(nodes, halvings, weights, {0, 1});
    ASSERT_EQ(tree.tiles().size(), halvings + 1);
    const HalvingCodes codes(6);
    std::mt19937 random(6);
    for (int i = 0; i < 2000; ++i) {
        std::vector<double> parts;
        for (std::size_t t = 0; t <= halvings; ++t)
            parts.push_back(random() % 4 == 0 ? 0.0 : std::exp2(double(random() % 100) - 50.0));
        const CodedRow row = tree.row(codes, parts, Unreached::left_out);
        for (std::size_t t = 0; t < parts.size(); ++t) {
            if (parts[t] > 0.0) {
                ASSERT_GE(row.steps[t], kStepsOfFloats) << i << ", " << t;
            } else {
                ASSERT_EQ(row.steps[t], 0u) << i << ", " << t;
            }
        }
    }
}

} // namespace
} // namespace acdf::compress
