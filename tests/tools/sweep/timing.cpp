// Times of samplers side by side, and their intervals.
#include "tests/inputs/synthetic.h"

#include "measure/samplers/light_samplers.h"
#include "tools/sweep/timing.h"

#include <gtest/gtest.h>

namespace acdf::tools {
namespace {

TEST(SweepTiming, IntervalsAreThoseOfOrderStatistics) {
    std::vector<double> values;
    for (int i = 31; i >= 1; --i) values.push_back(i);
    const Interval i = median_interval(values);
    // Binomial(31, 1/2): P(fewer than 10) = 0.0147, P(fewer than 11) = 0.0354.
    EXPECT_EQ(i.value, 16.0);
    EXPECT_EQ(i.low, 10.0);
    EXPECT_EQ(i.high, 22.0);
    EXPECT_EQ(median_interval({4.0, 2.0}).value, 3.0);
    EXPECT_EQ(median_interval({4.0, 2.0}).low, 2.0);
    EXPECT_FALSE(median_interval({}).known());
}

TEST(SweepTiming, EverySamplerHasAllRounds) {
    const compress::Target target = acdf_test::noise_target(32, 16, 3);
    const auto cdf = measure::full_cdf_sampler(target), cosine = measure::cosine_sampler();
    const std::vector<SweepTimes> times = time_samplers({cdf.get(), cosine.get()}, {{}, {}}, 5);
    ASSERT_EQ(times.size(), 2u);
    EXPECT_EQ(times[0].sample.size(), 5u);
    EXPECT_EQ(times[0].pdf.size(), 5u);
    EXPECT_EQ(times[1].sample.size(), 5u);
    EXPECT_EQ(times[1].pdf.size(), 5u);
}

} // namespace
} // namespace acdf::tools
