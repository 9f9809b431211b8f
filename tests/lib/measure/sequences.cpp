// Scrambled Sobol' points: nets in every part, uniform, independent between sets, and the same everywhere.
#include "measure/random.h"

#include <gtest/gtest.h>

#include <cmath>
#include <set>
#include <vector>

namespace acdf::measure {
namespace {

using Point = std::array<double, 2>;

std::vector<Point> points_of(std::uint64_t seed, std::size_t count) {
    ScrambledSobol sequence(seed);
    std::vector<Point> out;
    while (out.size() < count) out.push_back(sequence.next());
    return out;
}

// What defines a (0, 2)-sequence in base 2: of each part of 2^k points that begins at a multiple of 2^k, one lies
// in each of the elementary boxes 2^-i x 2^-(k-i), for every i.
TEST(ScrambledSobol, EveryPartIsANet) {
    constexpr std::size_t count = 512;
    for (const std::uint64_t seed : {0u, 1u, 77u, 4000000000u}) {
        const std::vector<Point> points = points_of(seed, count);
        for (int k = 0; k <= 9; ++k)
            for (std::size_t begin = 0; begin < count; begin += std::size_t{1} << k)
                for (int i = 0; i <= k; ++i) {
                    std::set<std::pair<int, int>> boxes;
                    for (std::size_t n = begin; n < begin + (std::size_t{1} << k); ++n)
                        boxes.emplace(static_cast<int>(std::ldexp(points[n][0], i)),
                                      static_cast<int>(std::ldexp(points[n][1], k - i)));
                    ASSERT_EQ(boxes.size(), std::size_t{1} << k) << seed << ": " << begin << ", " << i;
                }
    }
}

// A digit depends on those before it and on no other; whether it is flipped is even over seeds.
TEST(ScrambledSobol, DigitsAreFlippedByThoseBeforeThem) {
    Random random(3);
    std::array<int, 32> flips{};
    constexpr int trials = 4000;
    for (int n = 0; n < trials; ++n) {
        const auto seed = static_cast<std::uint32_t>(random()), x = static_cast<std::uint32_t>(random());
        const std::uint32_t scrambled = owen_scramble(x, seed);
        for (std::uint32_t bit = 0; bit < 32; ++bit) {
            const std::uint32_t after = bit == 0 ? 0u : (1u << bit) - 1u,
                                other = x ^ (1u << bit) ^ (after & 0x5A5A5A5Au);
            // x and `other` first differ in this digit, and so do their images.
            ASSERT_EQ((owen_scramble(other, seed) ^ scrambled) >> bit, 1u) << bit;
            flips[bit] += ((scrambled ^ x) >> bit & 1u) != 0;
        }
    }
    for (const int flipped : flips) EXPECT_NEAR(flipped, trials / 2, 4.0 * std::sqrt(trials / 4.0));
}

/// Neither smooth nor a product.
double integrand(const Point& u) { return std::exp(-u[0] * u[1]) + (u[0] + u[1] > 1.2 ? 3.0 : 0.0); }

struct Moments {
    double mean = 0.0, standard_error = 0.0;
};

Moments moments(const std::vector<double>& values) {
    const double n = static_cast<double>(values.size());
    double sum = 0.0, square = 0.0;
    for (const double v : values) sum += v / n;
    for (const double v : values) square += (v - sum) * (v - sum);
    return {sum, std::sqrt(square / (n * (n - 1.0)))};
}

/// By the midpoint rule, the edge cut exactly: the triangle above u + v = 1.2 has the area 0.8^2 / 2.
double exact_mean() {
    constexpr int n = 1000;
    double sum = 3.0 * 0.8 * 0.8 / 2.0;
    for (int i = 0; i < n; ++i)
        for (int k = 0; k < n; ++k) sum += std::exp(-(i + 0.5) / n * (k + 0.5) / n) / (double{n} * n);
    return sum;
}

TEST(ScrambledSobol, MeansAreUnbiasedForAnyCount) {
    const double exact = exact_mean();
    for (const std::size_t count : {1u, 3u, 16u, 20u}) {
        std::vector<double> estimates;
        for (std::uint64_t seed = 0; seed < 4000; ++seed) {
            double sum = 0.0;
            for (const Point& u : points_of(seed, count)) sum += integrand(u) / static_cast<double>(count);
            estimates.push_back(sum);
        }
        const Moments m = moments(estimates);
        EXPECT_NEAR(m.mean, exact, 4.0 * m.standard_error) << count;
    }
}

TEST(ScrambledSobol, HasLessVarianceThanIndependentNumbers) {
    const auto variance = [](Numbers numbers) {
        Random random(5, numbers);
        std::vector<double> estimates;
        for (int n = 0; n < 2000; ++n) {
            random.begin_set();
            double sum = 0.0;
            for (int i = 0; i < 64; ++i) sum += integrand(random.pair()) / 64.0;
            estimates.push_back(sum);
        }
        const double error = moments(estimates).standard_error;
        return error * error;
    };
    EXPECT_LT(variance(Numbers::sobol), 0.2 * variance(Numbers::independent));
}

// Sets are padded: what one samples says nothing about what another does, so that products have the product's mean.
TEST(ScrambledSobol, SetsAreIndependent) {
    Random random(11, Numbers::sobol);
    std::vector<double> products;
    for (int n = 0; n < 3000; ++n) {
        std::array<Point, 2> sets[4];
        for (auto& set : sets) {
            random.begin_set();
            for (Point& u : set) u = random.pair();
        }
        products.push_back((sets[0][0][0] - 0.5) * (sets[1][0][0] - 0.5) +
                           (sets[2][1][1] - 0.5) * (sets[3][1][0] - 0.5));
    }
    const Moments m = moments(products);
    EXPECT_NEAR(m.mean, 0.0, 4.0 * m.standard_error);
    EXPECT_NEAR(m.standard_error * std::sqrt(3000.0), std::sqrt(2.0) / 12.0, 0.01); // that of independent numbers
}

TEST(ScrambledSobol, IsTheSameEverywhere) {
    const std::vector<Point> a = points_of(1, 4);
    EXPECT_EQ(a, points_of(1, 4));
    EXPECT_NE(a, points_of(2, 4));
    const std::uint32_t expected[4][2] = {{240453734u, 1207553018u},
                                          {3951743102u, 2643577634u},
                                          {1325024993u, 3501645437u},
                                          {2234417337u, 777378054u}};
    for (std::size_t i = 0; i < 4; ++i)
        for (std::size_t k = 0; k < 2; ++k) EXPECT_EQ(std::ldexp(a[i][k], 32), expected[i][k]) << i << " " << k;
}

TEST(Random, IndependentNumbersAreTheGenerators) {
    Random random(9);
    std::mt19937_64 generator(9);
    random.begin_set();
    const Point u = random.pair();
    EXPECT_EQ(u[0], static_cast<double>(generator() >> 11) * 0x1p-53);
    EXPECT_EQ(u[1], static_cast<double>(generator() >> 11) * 0x1p-53);
    EXPECT_EQ(random(), generator());
}

} // namespace
} // namespace acdf::measure
