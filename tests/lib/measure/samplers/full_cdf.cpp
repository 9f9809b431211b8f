// FullCdf, the baseline: samples, pdfs, and a variance of nothing.
#include "tests/inputs/synthetic.h"
#include "tests/lib/compress/chi_square.h"

#include "measure/samplers/full_cdf.h"

#include <gtest/gtest.h>

#include <cmath>

namespace {

using acdf::compress::Target;
using acdf::measure::FullCdf;

class FullCdfOf : public ::testing::TestWithParam<acdf_test::NamedTarget> {};

TEST_P(FullCdfOf, IntegratesToOne) {
    const Target& t = GetParam().target;
    const FullCdf cdf(t);
    double sum = 0.0;
    for (std::uint32_t r = 0; r < t.rows; ++r)
        for (std::uint32_t c = 0; c < t.columns; ++c) sum += cdf.pdf(c, r) * t.row_measure[r] * t.column_measure[c];
    EXPECT_NEAR(sum, 1.0, 1e-5);
}

TEST_P(FullCdfOf, SamplesFollowTheTarget) {
    const Target& t = GetParam().target;
    const FullCdf cdf(t);
    std::mt19937_64 random(11);
    std::vector<std::uint32_t> observed(t.values.size(), 0);
    std::uint32_t bad = 0;
    for (int i = 0; i < 100000; ++i) {
        const auto draw = cdf.sample(static_cast<float>(random() >> 40) * 0x1p-24f,
                                     static_cast<float>(random() >> 40) * 0x1p-24f);
        const auto c = static_cast<std::uint32_t>(draw.column), r = static_cast<std::uint32_t>(draw.row);
        ASSERT_LT(c, t.columns);
        ASSERT_LT(r, t.rows);
        bad += draw.pdf != cdf.pdf(c, r) || !(draw.pdf > 0.0) || !std::isfinite(draw.pdf);
        ++observed[r * t.columns + c];
    }
    EXPECT_EQ(bad, 0u);
    std::vector<double> probability;
    const double total = acdf::compress::integral(t);
    for (std::uint32_t r = 0; r < t.rows; ++r)
        for (std::uint32_t c = 0; c < t.columns; ++c)
            probability.push_back(t.row(r)[c] * t.row_measure[r] * t.column_measure[c] / total);
    const auto test = acdf_test::chi_square(observed, probability);
    EXPECT_FALSE(test.impossible);
    EXPECT_GT(test.p_value, acdf_test::sidak(0.01, 12));
}

TEST_P(FullCdfOf, HasNoVariance) {
    EXPECT_NEAR(acdf::measure::full_cdf_relative_variance(GetParam().target), 0.0, 1e-10);
}

INSTANTIATE_TEST_SUITE_P(Synthetic, FullCdfOf, ::testing::ValuesIn(acdf_test::synthetic_targets()),
                         [](const auto& info) { return info.param.name; });

TEST(FullCdf, FillsATexelEvenly) {
    const Target t = acdf_test::texel_target(
        8, 4, [](std::uint32_t c, std::uint32_t r) { return c == 5 && r == 1 ? 2.0 : 0.0; });
    const FullCdf cdf(t);
    std::vector<std::uint32_t> observed(33 * 33, 0);
    std::mt19937_64 random(12);
    for (int i = 0; i < 100000; ++i) {
        const auto draw = cdf.sample(static_cast<float>(random() >> 40) * 0x1p-24f,
                                     static_cast<float>(random() >> 40) * 0x1p-24f);
        ASSERT_EQ(std::floor(draw.column), 5.0);
        ASSERT_EQ(std::floor(draw.row), 1.0);
        ++observed[static_cast<std::size_t>((draw.row - 1.0) * 33) * 33 +
                   static_cast<std::size_t>((draw.column - 5.0) * 33)];
    }
    EXPECT_GT(acdf_test::chi_square(observed, std::vector<double>(33 * 33, 1.0 / (33 * 33))).p_value, 0.001);
}

TEST(FullCdf, LightAtTheEndsOfFloatsIsSampledAsAnyOther) {
    for (const double light : {1.4e-45, 1e-40, 1.0, 3.4e38}) {
        const Target one = acdf_test::texel_target(
            32, 16, [&](std::uint32_t c, std::uint32_t r) { return c == 3 && r == 3 ? light : 0.0; });
        EXPECT_NEAR(FullCdf(one).pdf(3, 3) * one.row_measure[3] * one.column_measure[3], 1.0, 1e-6) << light;
        const Target all = acdf_test::texel_target(32, 16, [&](std::uint32_t, std::uint32_t) { return light; });
        EXPECT_NEAR(acdf::measure::full_cdf_relative_variance(all), 0.0, 1e-10) << light;
    }
}

TEST(FullCdf, SizeIsEightBytesATexel) {
    const Target t = acdf_test::noise_target(512, 256, 1);
    EXPECT_NEAR(static_cast<double>(FullCdf(t).bytes()) / (512 * 256), 8.0, 0.05);
}

} // namespace
