// Elementary functions of the reader against those of the library.
#include "tests/lib/reader/sampling.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

using namespace acdf_test;

namespace {

TEST(ElementaryFunctions, matchTheLibrary) {
    std::mt19937_64 rng(1);
    for (int n = 0; n < 200000; ++n) {
        const double x = 4 * uniform(rng) - 2, y = 4 * uniform(rng) - 2;
        const double scale = std::ldexp(1.0, static_cast<int>(rng() % 60) - 50);
        double sine, cosine;
        acdf_sincospi(x / 2, &sine, &cosine);
        ASSERT_NEAR(sine, std::sin(M_PI * x / 2), 1e-15) << x;
        ASSERT_NEAR(cosine, std::cos(M_PI * x / 2), 1e-15) << x;
        ASSERT_NEAR(acdf_atan2pi(y * scale, x), std::atan2(y * scale, x) / M_PI, 4e-16) << y << ' ' << x;
        ASSERT_NEAR(acdf_atan2pi(y, x * scale), std::atan2(y, x * scale) / M_PI, 4e-16) << y << ' ' << x;
    }
    for (std::uint32_t rows : {1u, 2u, 3u, 511u, 65536u})
        for (std::uint32_t row = 0; row <= rows; ++row) {
            const double z = acdf_row_z(row, rows);
            ASSERT_NEAR(z, std::cos(M_PI * row / rows), 1e-15) << row << ' ' << rows;
            if (row > 0) {
                ASSERT_LT(z, acdf_row_z(row - 1, rows)) << row << ' ' << rows;
            }
        }
    EXPECT_EQ(acdf_row_z(0, 7), 1.0);
    EXPECT_EQ(acdf_row_z(7, 7), -1.0);
    EXPECT_EQ(acdf_atan2pi(0.0, 1.0), 0.0);
    EXPECT_EQ(acdf_atan2pi(0.0, -1.0), 1.0);
    EXPECT_EQ(acdf_atan2pi(1.0, 0.0), 0.5);
    EXPECT_EQ(acdf_atan2pi(-1.0, 0.0), -0.5);
    EXPECT_EQ(acdf_atan2pi(1.0, 1.0), 0.25);
    EXPECT_EQ(acdf_atan2pi(0.0, 0.0), 0.0);
}

TEST(ElementaryFunctions, chooseOnlyWhatIsBelow) {
    const double numbers[] = {-1e300, -1.0, -1e-300, -0.0, 0.0, 1e-300, 1.0, 1e300};
    for (const double a : numbers)
        for (const double b : numbers) EXPECT_EQ(acdf_if_less(a, b, 3.0), a < b ? 3.0 : 0.0) << a << ' ' << b;
}

} // namespace
