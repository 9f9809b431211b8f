// The alias method samples each of n as often as its mass says.
#include "measure/samplers/alias_choices.h"

#include <gtest/gtest.h>

#include <cstdint>
#include <numeric>
#include <random>
#include <vector>

namespace acdf::measure {
namespace {

/// Of mean 1: a few large ones, many small ones, and some that are 0.
std::vector<double> uneven(std::size_t count, std::uint64_t seed) {
    std::mt19937_64 random(seed);
    std::lognormal_distribution<double> size(0.0, 2.0);
    std::vector<double> mass(count);
    for (std::size_t i = 0; i < count; ++i) mass[i] = count > 1 && i % 7 == 3 ? 0.0 : size(random);
    const double mean = std::accumulate(mass.begin(), mass.end(), 0.0) / static_cast<double>(count);
    for (double& m : mass) m /= mean;
    return mass;
}

TEST(AliasChoices, StandForMassesInAll) {
    for (const std::size_t count : {1u, 2u, 3u, 1000u, 65536u}) {
        const std::vector<double> mass = uneven(count, count);
        const std::vector<AliasChoice> choices = alias_choices(mass);
        ASSERT_EQ(choices.size(), count);
        std::vector<double> sampled(count), rounded(count, 1e-9); // each choice is a float
        for (std::size_t i = 0; i < count; ++i) {
            ASSERT_TRUE(choices[i].keep >= 0.0f && choices[i].keep <= 1.0f) << i;
            ASSERT_LT(choices[i].alias, count) << i;
            sampled[i] += double{choices[i].keep};
            sampled[choices[i].alias] += 1.0 - double{choices[i].keep};
            rounded[i] += 0x1p-24;
            rounded[choices[i].alias] += 0x1p-24;
        }
        for (std::size_t i = 0; i < count; ++i) {
            EXPECT_NEAR(sampled[i], mass[i], rounded[i]) << i << " of " << count;
            EXPECT_EQ(sampled[i] > 0.0, mass[i] > 0.0) << i << " of " << count;
        }
    }
}

TEST(AliasChoices, OfOneMassThatIsAllNoOtherIsSampled) {
    const std::vector<AliasChoice> choices = alias_choices({0.0, 0.0, 4.0, 0.0});
    for (std::size_t i = 0; i < choices.size(); ++i) {
        EXPECT_EQ(choices[i].keep, i == 2 ? 1.0f : 0.0f) << i;
        EXPECT_EQ(choices[i].alias, 2u) << i;
    }
}

} // namespace
} // namespace acdf::measure
