// Real probabilities to stored integers.
#include "tests/inputs/synthetic.h"

#include "compress/store/quantize.h"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <stdexcept>

namespace {

using namespace acdf::compress;

constexpr std::uint64_t kByte = 0xFF, kNarrow = 0xFFFF, kWide = 0xFFFFFFFF;

std::vector<double> normalised(std::vector<double> p) {
    const double sum = std::accumulate(p.begin(), p.end(), 0.0);
    for (double& value : p) value /= sum;
    return p;
}

/// Shares over many powers of ten, some of them 0.
std::vector<double> random_probability(std::uint64_t seed, std::size_t n, double decades, double dark) {
    std::mt19937_64 random(seed);
    std::vector<double> p;
    for (std::size_t i = 0; i < n; ++i) {
        const double u = acdf_test::uniform(random);
        p.push_back(acdf_test::uniform(random) < dark ? 0.0 : std::pow(10.0, -decades * u));
    }
    if (*std::max_element(p.begin(), p.end()) == 0.0) p[0] = 1.0;
    return normalised(p);
}

void check_shares(const std::vector<double>& p, const std::vector<std::uint64_t>& shares, std::uint64_t maximum,
                  std::uint64_t smallest) {
    ASSERT_EQ(shares.size(), p.size());
    ASSERT_EQ(std::accumulate(shares.begin(), shares.end(), std::uint64_t{0}), maximum);
    for (std::size_t i = 0; i < p.size(); ++i) {
        ASSERT_EQ(shares[i] == 0, p[i] == 0.0) << i;
        ASSERT_TRUE(p[i] == 0.0 || shares[i] >= smallest) << i;
    }
    // A larger probability never gets a smaller share.
    std::vector<std::size_t> order(p.size());
    std::iota(order.begin(), order.end(), 0);
    std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return p[a] < p[b]; });
    for (std::size_t k = 1; k < order.size(); ++k)
        ASSERT_TRUE(p[order[k - 1]] == p[order[k]] || shares[order[k - 1]] <= shares[order[k]]);
    // Those above the floor are within one of a common multiple of their probability.
    double mass = 0.0, given = 0.0;
    for (std::size_t i = 0; i < p.size(); ++i)
        if (shares[i] > smallest) mass += p[i], given += static_cast<double>(shares[i]);
    std::size_t above = 0;
    for (std::size_t i = 0; i < p.size(); ++i) above += shares[i] > smallest;
    for (std::size_t i = 0; i < p.size(); ++i) {
        if (shares[i] <= smallest) continue;
        const double ideal = p[i] / mass * given;
        ASSERT_NEAR(static_cast<double>(shares[i]), ideal, 2.0 + double(above) * p[i] / mass) << i;
    }
}

void check_widths(const std::vector<double>& p) {
    if (p.size() <= kByte) check_shares(p, apportion(p, kByte, 1), kByte, 1);
    check_shares(p, apportion(p, kNarrow, 1), kNarrow, 1);
    check_shares(p, apportion(p, kWide, 256), kWide, 256);
}

RC_GTEST_PROP(Apportion, SumsAndFloorsHold, ()) {
    const auto seed = *rc::gen::inRange<std::uint64_t>(0, 1u << 30);
    const auto n = *rc::gen::inRange<std::size_t>(1, 2000);
    const double decades = *rc::gen::element(0.0, 1.0, 4.0, 9.0, 300.0);
    check_widths(random_probability(seed, n, decades, *rc::gen::element(0.0, 0.2, 0.99)));
    RC_ASSERT(!::testing::Test::HasFailure());
}

TEST(Apportion, RoundsToLargestRemainders) {
    // Ideal shares of 10: 4.6, 3.3, 2.1.
    EXPECT_EQ(apportion({0.46, 0.33, 0.21}, 10, 1), (std::vector<std::uint64_t>{5, 3, 2}));
    // The floor takes 1 of 10; the rest is shared 2 : 1 among 9.
    EXPECT_EQ(apportion({0.6, 0.001, 0.399, 0.0}, 10, 1), (std::vector<std::uint64_t>{5, 1, 4, 0}));
}

TEST(Apportion, OneElementTakesAll) {
    EXPECT_EQ(apportion({1.0}, kNarrow, 1), std::vector<std::uint64_t>{kNarrow});
    EXPECT_EQ(apportion({1.0}, kWide, 256), std::vector<std::uint64_t>{kWide});
    check_widths({0.0, 0.0, 1.0});
}

TEST(Apportion, MillionsToOne) {
    check_widths(normalised({1.0, 1e-7, 1e-12, 1e-300, 1.0, 0.0, 5e-324}));
    std::vector<double> one_sun(1000, 1e-15);
    one_sun[700] = 1.0;
    check_widths(normalised(one_sun));
    EXPECT_EQ(apportion(normalised(one_sun), kNarrow, 1)[700], kNarrow - 999);
}

TEST(Apportion, AllTiny) { // sums that a caller forgot to normalise
    check_widths(std::vector<double>(500, 1e-300));
    // At once, not one share at a time, where the scale to whole shares would be infinite.
    EXPECT_EQ(apportion({3e-310, 1e-310}, kWide, 256), apportion({0.75, 0.25}, kWide, 256));
}

TEST(Apportion, AsManyAsThereAreShares) {
    const std::vector<double> p = random_probability(3, kNarrow, 6.0, 0.0);
    EXPECT_EQ(apportion(p, kNarrow, 1), std::vector<std::uint64_t>(kNarrow, 1));
    EXPECT_EQ(apportion(std::vector<double>(kNarrow, 1.0 / kNarrow), kNarrow, 1),
              std::vector<std::uint64_t>(kNarrow, 1));
    std::vector<double> one_more(kNarrow + 1, 1.0 / (kNarrow + 1));
    EXPECT_THROW(apportion(one_more, kNarrow, 1), std::invalid_argument);
    one_more[7] = 0.0; // nothing needs no share
    EXPECT_EQ(apportion(one_more, kNarrow, 1)[7], 0u);
    EXPECT_THROW(apportion({0.4, 0.3, 0.3}, 1000, 400), std::invalid_argument);
}

TEST(Apportion, FloorsThatPushOthersToTheFloor) {
    // 990 shares of 16 leave little of 16,000 for the rest, which then fall below 16 themselves.
    std::vector<double> p(990, 1e-9);
    for (int i = 0; i < 10; ++i) p.push_back(0.1 + 0.001 * i);
    check_shares(normalised(p), apportion(normalised(p), 16000 + 5, 16), 16000 + 5, 16);
}

TEST(QuantizationExcess, IsTheSumOfSquaresOverShares) {
    EXPECT_DOUBLE_EQ(quantization_excess({0.5, 0.5}, {1, 3}), 0.0625 / 0.25 + 0.0625 / 0.75);
    EXPECT_EQ(quantization_excess({0.25, 0.75, 0.0}, {1, 3, 0}), 0.0);
}

std::vector<double> shares_of(const QuantizedCurve& curve) {
    std::vector<double> shares;
    const double maximum = double(std::array{kByte, kNarrow, kWide}[curve.code]);
    double before = 0.0;
    for (std::uint32_t value : curve.cumulative) {
        shares.push_back((value - before) / maximum);
        before = value;
    }
    shares.push_back((maximum - before) / maximum);
    return shares;
}

/// Bytes and excess of one width; infinite where it cannot hold all segments.
double cost_of(const std::vector<double>& p, std::uint32_t code, double reach, double price) {
    const std::uint64_t maximum = std::array{kByte, kNarrow, kWide}[code];
    const auto lit =
        static_cast<std::uint64_t>(std::count_if(p.begin(), p.end(), [](double v) { return v > 0.0; }));
    if (lit > maximum) return INFINITY;
    const double bytes = static_cast<double>((p.size() - 1) << code);
    return bytes * price + reach * quantization_excess(p, apportion(p, maximum, code == 2 ? 256 : 1));
}

RC_GTEST_PROP(Quantize, TakesTheWidthThatCostsLeast, ()) {
    const auto seed = *rc::gen::inRange<std::uint64_t>(0, 1u << 30);
    const auto n = *rc::gen::inRange<std::size_t>(1, 500);
    const double price = *rc::gen::element(0.0, 1e-12, 1e-8, 1e-5), reach = *rc::gen::element(1e-6, 1.0);
    const auto p = random_probability(seed, n, *rc::gen::element(0.5, 3.0, 8.0), 0.1);
    const QuantizedCurve curve = quantize(p, reach, price);
    const auto q = shares_of(curve);
    RC_ASSERT(curve.cumulative.size() + 1 == n);
    RC_ASSERT(std::is_sorted(curve.cumulative.begin(), curve.cumulative.end()));
    double excess = 0.0;
    for (std::size_t i = 0; i < n; ++i) {
        RC_ASSERT((q[i] > 0.0) == (p[i] > 0.0));
        if (p[i] > 0.0) excess += (p[i] - q[i]) * (p[i] - q[i]) / q[i];
        if (curve.code == 2 && p[i] > 0.0) RC_ASSERT(q[i] >= 0x1p-24);
    }
    const double cost = static_cast<double>((n - 1) << curve.code) * price + reach * excess;
    for (std::uint32_t code = 0; code < 3; ++code)
        RC_ASSERT(cost <= cost_of(p, code, reach, price) * (1.0 + 1e-9) + 1e-15);
}

TEST(Quantize, WidensWhereNarrowOnesCannotHoldAll) {
    for (const std::uint64_t n : {kByte, kNarrow}) {
        const std::uint32_t code = n == kByte ? 0 : 1;
        EXPECT_EQ(quantize(std::vector<double>(n, 1.0 / double(n)), 1.0, 1e-8).code, code);
        EXPECT_EQ(quantize(std::vector<double>(n + 1, 1.0 / double(n + 1)), 1.0, 1e9).code, code + 1);
    }
    EXPECT_EQ(quantize({1.0}, 1.0, 0.0).code, 0u);
    EXPECT_EQ(quantize({0.0, 1.0, 0.0}, 1.0, 0.0).code, 0u);
}

TEST(Quantize, CurvesThatAreNeverReachedAreNarrow) {
    EXPECT_EQ(quantize({0.3, 0.7}, 0.0, 1e-8).code, 0u);
    EXPECT_EQ(quantize({0.3, 0.7}, 1.0, 0.0).code, 2u);
}

} // namespace
