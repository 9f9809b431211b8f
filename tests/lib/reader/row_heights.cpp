// Squares of the lat-long grid by floats: where floats decide they agree with doubles, and nearly all are decided.
#include "tests/inputs/sanitized.h"

#include <acdf/row_heights.h>

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <random>
#include <vector>

namespace {

using Direction = std::array<float, 3>;

/// Directions anywhere, close to poles, to the equator's axes and diagonals and to 45 degrees of height, of lengths
/// that floats still serve.
std::vector<Direction> row_directions(std::size_t count) {
    std::mt19937_64 random(1);
    std::uniform_real_distribution<double> uniform(0.0, 1.0);
    const auto near = [&] { return (uniform(random) - 0.5) * std::pow(10.0, -7.0 * uniform(random)); };
    std::vector<Direction> out(count);
    for (std::size_t i = 0; i < count; ++i) {
        double phi = 2.0 * ACDF_PI * uniform(random), theta = std::acos(1.0 - 2.0 * uniform(random));
        if (i % 4 == 1) phi = ACDF_PI / 4.0 * std::floor(8.0 * uniform(random)) + near();
        if (i % 4 == 2) theta = ACDF_PI / 4.0 * std::floor(5.0 * uniform(random)) + near();
        const double length = i % 3 == 0 ? 1.0 + 9e-5 * (uniform(random) - 0.5) : 1.0;
        const double r = length * std::sin(theta), z = length * std::cos(theta);
        out[i] = {static_cast<float>(r * std::cos(phi)), static_cast<float>(r * std::sin(phi)),
                  static_cast<float>(z)};
        if (i % 404 == 0) out[i][1] = i % 8 ? 0.0f : -0.0f;
        if (i % 412 == 0) out[i][0] = 1e-30f;
    }
    return out;
}

TEST(RowHeights, FindSquaresAsDoublesDo) {
    const std::vector<Direction> directions = row_directions(static_cast<std::size_t>(acdf_test::repeated(400000)));
    const std::uint32_t grids[][2] = {{1, 1}, {3, 2}, {1024, 512}, {1000, 333}, {65536, 65536}};
    for (const auto& grid : grids) {
        SCOPED_TRACE(testing::Message() << grid[0] << " x " << grid[1]);
        std::size_t asked = 0, told = 0;
        for (std::size_t i = 0; i < directions.size(); ++i) {
            const float* const d = directions[i].data();
            std::uint32_t square[2], exact[2];
            double column;
            const int sure = acdf_row_square(grid[0], grid[1], d, square);
            if (i % 4 == 3) asked += 1, told += sure != 0; // anywhere
            if (!sure) continue;
            ASSERT_TRUE(acdf_sphere_square(grid[0], grid[1], d, exact, &column)) << i;
            ASSERT_TRUE(square[0] == exact[0] && square[1] == exact[1]) << d[0] << ' ' << d[1] << ' ' << d[2];
        }
        EXPECT_GT(told, asked - asked / (grid[0] > 1024 ? 5 : 100));
    }
}

TEST(RowHeights, RefuseWhatIsNoDirection) {
    const float infinity = HUGE_VALF;
    for (const Direction& d :
         {Direction{0.0f, 0.0f, 1.0f}, Direction{0.0f, 0.0f, 0.0f}, Direction{0.6f, 0.0f, 0.801f},
          Direction{std::nanf(""), 0.0f, 1.0f}, Direction{0.6f, std::nanf(""), 0.8f},
          Direction{infinity, 0.6f, 0.8f}, Direction{0.6f, 0.8f, -infinity}}) {
        std::uint32_t square[2];
        EXPECT_FALSE(acdf_row_square(1024, 512, d.data(), square)) << d[0] << ' ' << d[1] << ' ' << d[2];
    }
}

} // namespace
