// fit_curve_*: knots, masses, slopes.
#include "tests/inputs/synthetic.h"

#include "compress/fit/curve.h"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>

namespace {

using namespace acdf::compress;

using Knots = std::vector<std::uint32_t>;

Distribution random_distribution(std::uint64_t seed, std::size_t steps, double dark) {
    std::mt19937_64 random(seed);
    Distribution d;
    for (std::size_t i = 0; i < steps; ++i) {
        const double u = acdf_test::uniform(random);
        d.mass.push_back(acdf_test::uniform(random) < dark ? 0.0 : 0.01 + 50.0 * u * u * u);
        d.measure.push_back(0.1 + acdf_test::uniform(random));
    }
    if (*std::max_element(d.mass.begin(), d.mass.end()) == 0.0) d.mass[steps / 2] = 1.0;
    return d;
}

Distribution random_distribution() {
    return random_distribution(*rc::gen::inRange<std::uint64_t>(0, 1u << 30),
                               *rc::gen::inRange<std::size_t>(1, 100), *rc::gen::element(0.0, 0.3, 0.9));
}

std::vector<std::uint32_t> ends_of(const Curve& curve, std::size_t steps) {
    std::vector<std::uint32_t> ends{0};
    ends.insert(ends.end(), curve.knots.begin(), curve.knots.end());
    ends.push_back(static_cast<std::uint32_t>(steps));
    return ends;
}

/// Each segment carries the share of mass that lies in it, and nothing is lost.
void assert_masses(const Distribution& d, const Curve& curve) {
    const auto ends = ends_of(curve, d.mass.size());
    const long double total = std::accumulate(d.mass.begin(), d.mass.end(), 0.0L);
    RC_ASSERT(curve.probability.size() == curve.segments());
    double sum = 0.0;
    for (std::size_t s = 0; s < curve.segments(); ++s) {
        RC_ASSERT(ends[s] < ends[s + 1]);
        const long double mass = std::accumulate(d.mass.begin() + ends[s], d.mass.begin() + ends[s + 1], 0.0L);
        RC_ASSERT(std::abs(curve.probability[s] - static_cast<double>(mass / total)) <= 1e-15);
        RC_ASSERT((curve.probability[s] == 0.0) == (mass == 0.0L));
        sum += curve.probability[s];
    }
    RC_ASSERT(std::abs(sum - 1.0) < 1e-14);
}

RC_GTEST_PROP(FitCurve, EverySegmentCarriesItsMass, ()) {
    const Distribution d = random_distribution();
    const CurveBudget budget{*rc::gen::inRange<std::uint32_t>(1, 120), *rc::gen::element(0.0, 0.01, 0.2)};
    for (const Curve& curve : {fit_curve_uniform(d, budget), fit_curve_cdf(d, budget), fit_curve_pdf(d, budget)}) {
        RC_ASSERT(curve.segments() <= budget.segments);
        assert_masses(d, curve);
    }
}

RC_GTEST_PROP(FitCurve, CdfStaysWithinEpsilon, ()) {
    const Distribution d = random_distribution();
    const double epsilon = *rc::gen::element(0.001, 0.01, 0.1);
    const Curve curve = fit_curve_cdf(d, {1000, epsilon});
    const auto ends = ends_of(curve, d.mass.size());
    const double total = std::accumulate(d.mass.begin(), d.mass.end(), 0.0);
    double exact = 0.0, knot = 0.0;
    for (std::size_t s = 0; s < curve.segments(); ++s) {
        const double length = std::accumulate(d.measure.begin() + ends[s], d.measure.begin() + ends[s + 1], 0.0);
        double x = 0.0;
        for (std::uint32_t i = ends[s]; i < ends[s + 1]; ++i) {
            exact += d.mass[i] / total;
            x += d.measure[i];
            RC_ASSERT(std::abs(exact - (knot + curve.probability[s] * x / length)) <= epsilon + 1e-12);
        }
        knot += curve.probability[s];
    }
}

TEST(FitCurveUniform, SpacesKnotsEvenly) {
    const Distribution d = random_distribution(1, 12, 0.0);
    EXPECT_EQ(fit_curve_uniform(d, {4, 0.0}).knots, (Knots{3, 6, 9}));
    EXPECT_EQ(fit_curve_uniform(d, {5, 0.0}).knots, (Knots{2, 4, 7, 9}));
    EXPECT_EQ(fit_curve_uniform(d, {1, 0.0}).knots, Knots{});
    EXPECT_EQ(fit_curve_uniform(d, {100, 0.0}).segments(), 12u);
}

TEST(FitCurveCdf, PutsKnotsWhereAPiecewiseConstantPdfJumps) {
    Distribution d{std::vector<double>(64, 1.0), std::vector<double>(64, 1.0)};
    std::fill(d.mass.begin() + 16, d.mass.begin() + 24, 16.0);
    std::fill(d.mass.begin() + 48, d.mass.end(), 4.0);
    const Curve curve = fit_curve_cdf(d, {64, 1e-9});
    EXPECT_EQ(curve.knots, (Knots{16, 24, 48}));
    EXPECT_TRUE(curve.tilts.empty());
}

TEST(FitCurvePdf, FollowsALinearPdfWithOneSegment) {
    // The pdf 1 + s (2t - 1) with s = 0.5 on 64 equal steps.
    Distribution d{{}, std::vector<double>(64, 1.0)};
    for (int i = 0; i < 64; ++i) d.mass.push_back(1.0 + 0.5 * (2.0 * (i + 0.5) / 64 - 1.0));
    const Curve curve = fit_curve_pdf(d, {8, 0.01});
    ASSERT_EQ(curve.segments(), 1u);
    EXPECT_NEAR(curve.tilts[0], 0.5, 1e-3);
}

TEST(FitCurvePdf, NeedsFewerSegmentsThanCdfOnASmoothPdf) {
    Distribution d{{}, std::vector<double>(256, 1.0)};
    for (int i = 0; i < 256; ++i) d.mass.push_back(1.0 + std::sin(acdf_test::kPi * (i + 0.5) / 256));
    const auto cost = [&](const Curve& curve) { // the integral of f^2 / p
        const auto ends = ends_of(curve, 256);
        const double total = std::accumulate(d.mass.begin(), d.mass.end(), 0.0);
        double sum = 0.0;
        for (std::size_t s = 0; s < curve.segments(); ++s)
            for (std::uint32_t i = ends[s]; i < ends[s + 1]; ++i) {
                const double length = ends[s + 1] - ends[s], t = (i - ends[s] + 0.5) / length;
                const double tilt = curve.tilts.empty() ? 0.0 : curve.tilts[s];
                const double p = curve.probability[s] / length * (1.0 + tilt * (2.0 * t - 1.0));
                sum += d.mass[i] / total * d.mass[i] / total / p;
            }
        return sum - 1.0;
    };
    EXPECT_LT(cost(fit_curve_pdf(d, {8, 0.0})), 0.25 * cost(fit_curve_cdf(d, {8, 0.0})));
}

/// The integral of f^2/p over steps [begin, end), by 200 midpoints a step.
double dense_cost(const Distribution& d, std::uint32_t begin, std::uint32_t end, double tilt) {
    const double length = std::accumulate(d.measure.begin() + begin, d.measure.begin() + end, 0.0);
    double sum = 0.0, x = 0.0;
    for (std::uint32_t i = begin; i < end; ++i) {
        const double density = d.mass[i] / d.measure[i];
        for (int k = 0; k < 200; ++k) {
            const double t = (x + d.measure[i] * (k + 0.5) / 200) / length;
            sum += density * density * d.measure[i] / 200 / (1.0 + tilt * (2.0 * t - 1.0));
        }
        x += d.measure[i];
    }
    return sum;
}

TEST(BestTilt, CostsNoMoreThanAnyOther) {
    for (std::uint64_t seed = 0; seed < 30; ++seed) {
        SCOPED_TRACE(seed);
        const Distribution d = random_distribution(seed, 20, seed % 3 == 0 ? 0.7 : 0.0);
        const auto begin = static_cast<std::uint32_t>(seed % 5),
                   end = begin + 2 + static_cast<std::uint32_t>(seed % 12);
        if (dense_cost(d, begin, end, 0.0) == 0.0) continue;
        double best = 0.0, least = dense_cost(d, begin, end, 0.0);
        for (int k = -249; k <= 249; ++k) {
            const double cost = dense_cost(d, begin, end, k / 250.0);
            if (cost < least) least = cost, best = k / 250.0;
        }
        const double tilt = best_tilt(d, begin, end);
        EXPECT_LE(dense_cost(d, begin, end, tilt), least * (1.0 + 1e-4));
        if (std::abs(best) < 0.95) {
            EXPECT_NEAR(tilt, best, 0.01);
        }
        EXPECT_LT(std::abs(tilt), 1.0);
    }
}

TEST(BestTilt, IsZeroWithoutSlope) {
    const Distribution flat{std::vector<double>(10, 2.0), std::vector<double>(10, 0.5)};
    EXPECT_NEAR(best_tilt(flat, 0, 10), 0.0, 1e-4);
    EXPECT_EQ(best_tilt(flat, 3, 4), 0.0);
    const Distribution dark{{0, 0, 0, 1}, {1, 1, 1, 1}};
    EXPECT_EQ(best_tilt(dark, 0, 3), 0.0);
}

TEST(BestTilt, NeverReachesPdfZeroAtEitherEnd) {
    const Distribution step{{0, 0, 0, 0, 0, 0, 0, 1}, std::vector<double>(8, 1.0)};
    EXPECT_GT(best_tilt(step, 0, 8), 0.9);
    EXPECT_LT(best_tilt(step, 0, 8), 1.0);
}

TEST(CurveThrough, SurvivesMassesMillionsApart) {
    Distribution d{std::vector<double>(1000, 1e-12), std::vector<double>(1000, 1.0)};
    d.mass[500] = 1e12;
    const Curve curve = curve_through(d, {500, 501});
    EXPECT_NEAR(curve.probability[0] / 5e-22, 1.0, 1e-12);
    EXPECT_NEAR(curve.probability[2] / 4.99e-22, 1.0, 1e-12);
    EXPECT_EQ(curve.probability[1], 1.0);
}

} // namespace
