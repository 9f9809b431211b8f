// Every fit, both orders, on synthetic targets.
#include "tests/inputs/synthetic.h"
#include "tests/lib/compress/checks.h"
#include "tests/lib/compress/chi_square.h"

#include <gtest/gtest.h>

namespace {

using acdf_test::NamedTarget;

class EveryFit : public ::testing::TestWithParam<NamedTarget> {};

TEST_P(EveryFit, IsAPdfThatCoversTheTarget) {
    for (const auto& fit : acdf_test::all_fits(14, 11, 130)) acdf_test::check_fit(GetParam().target, fit);
}

INSTANTIATE_TEST_SUITE_P(Synthetic, EveryFit, ::testing::ValuesIn(acdf_test::synthetic_targets()),
                         [](const auto& info) { return info.param.name; });
INSTANTIATE_TEST_SUITE_P(Octahedral, EveryFit, ::testing::ValuesIn(acdf_test::octahedral_targets()),
                         [](const auto& info) { return info.param.name; });

// ---- the test itself ------------------------------------------------------------------------------------

TEST(ChiSquareTest, MatchesTheTables) {
    EXPECT_NEAR(acdf_test::gamma_q(0.5, 0.5 * 3.841459), 0.05, 1e-7);
    EXPECT_NEAR(acdf_test::gamma_q(5.0, 0.5 * 18.307038), 0.05, 1e-7);
    EXPECT_NEAR(acdf_test::gamma_q(500.0, 0.5 * 1074.679), 0.05, 1e-5);
    EXPECT_NEAR(acdf_test::gamma_q(1.0, 20.0) / std::exp(-20.0), 1.0, 1e-12);
    EXPECT_EQ(acdf_test::gamma_q(3.0, 0.0), 1.0);
    EXPECT_NEAR(acdf_test::sidak(0.01, 1), 0.01, 1e-15);
    EXPECT_NEAR(std::pow(1.0 - acdf_test::sidak(0.01, 500), 500), 0.99, 1e-12);
}

TEST(ChiSquareTest, SeesAOnePercentError) {
    std::mt19937_64 random(1);
    std::vector<std::uint32_t> observed(31, 0);
    for (int i = 0; i < 1000000; ++i) ++observed[static_cast<std::size_t>(acdf_test::uniform(random) * 31)];
    std::vector<double> right(31, 1.0 / 31), wrong = right;
    wrong[3] *= 1.03, wrong[20] -= 0.03 / 31;
    EXPECT_GT(acdf_test::chi_square(observed, right).p_value, 0.01);
    EXPECT_LT(acdf_test::chi_square(observed, wrong).p_value, 1e-6);
    right[0] = 0.0;
    EXPECT_TRUE(acdf_test::chi_square(observed, right).impossible);
}

} // namespace
