// douglas_peucker against slow, obvious references.
#include "tests/inputs/synthetic.h"

#include "compress/fit/polyline.h"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>

namespace {

using acdf::compress::douglas_peucker;
using Points = std::vector<double>;
using Knots = std::vector<std::uint32_t>;

constexpr std::uint32_t kUnlimited = 0xFFFFFFFF;

double deviation(const Points& x, const Points& y, std::size_t a, std::size_t b, std::size_t i) {
    const double slope = (y[b] - y[a]) / (x[b] - x[a]);
    return std::abs(y[i] - (y[a] + slope * (x[i] - x[a])));
}

/// The textbook recursion: split at the worst point until none deviates by more than epsilon.
void recurse(const Points& x, const Points& y, std::size_t a, std::size_t b, double epsilon, Knots& knots) {
    std::size_t worst = a;
    for (std::size_t i = a + 1; i < b; ++i)
        if (worst == a || deviation(x, y, a, b, i) > deviation(x, y, a, b, worst)) worst = i;
    if (worst == a || deviation(x, y, a, b, worst) <= epsilon) return;
    recurse(x, y, a, worst, epsilon, knots);
    knots.push_back(static_cast<std::uint32_t>(worst));
    recurse(x, y, worst, b, epsilon, knots);
}

/// One knot at a time: of all points the one farthest from the present polyline, the leftmost of equals.
Knots insert_one_by_one(const Points& x, const Points& y, std::uint32_t segments, double epsilon) {
    std::vector<std::size_t> ends{0, x.size() - 1};
    while (ends.size() - 1 < segments) {
        std::size_t worst = 0;
        double most = 0.0;
        for (std::size_t k = 0; k + 1 < ends.size(); ++k)
            for (std::size_t i = ends[k] + 1; i < ends[k + 1]; ++i)
                if (const double d = deviation(x, y, ends[k], ends[k + 1], i); d > most) most = d, worst = i;
        if (most <= epsilon) break;
        ends.insert(std::upper_bound(ends.begin(), ends.end(), worst), worst);
    }
    return Knots(ends.begin() + 1, ends.end() - 1);
}

struct Polyline {
    Points x, y;
};

Polyline random_polyline(std::uint64_t seed, std::size_t n, bool monotone) {
    std::mt19937_64 random(seed);
    Polyline p{Points(n, 0.0), Points(n, 0.0)};
    for (std::size_t i = 1; i < n; ++i) {
        p.x[i] = p.x[i - 1] + 0.01 + acdf_test::uniform(random);
        const double step = acdf_test::uniform(random);
        p.y[i] = monotone ? p.y[i - 1] + step * step * step : step;
    }
    return p;
}

RC_GTEST_PROP(DouglasPeucker, StopsAtEpsilonLikeTheRecursion, ()) {
    const auto n = *rc::gen::inRange<std::size_t>(2, 120);
    const auto p = random_polyline(*rc::gen::inRange<std::uint64_t>(0, 1u << 30), n, *rc::gen::arbitrary<bool>());
    const double epsilon = *rc::gen::inRange(0, 1000) * 1e-3;
    Knots expected;
    recurse(p.x, p.y, 0, n - 1, epsilon, expected);
    RC_ASSERT(douglas_peucker(p.x, p.y, kUnlimited, epsilon) == expected);
}

RC_GTEST_PROP(DouglasPeucker, StopsAtTheCountLikeInsertionOneByOne, ()) {
    const auto n = *rc::gen::inRange<std::size_t>(2, 120);
    const auto p = random_polyline(*rc::gen::inRange<std::uint64_t>(0, 1u << 30), n, *rc::gen::arbitrary<bool>());
    const auto segments = *rc::gen::inRange<std::uint32_t>(1, 130);
    const double epsilon = *rc::gen::element(0.0, 0.02, 0.3);
    const Knots knots = douglas_peucker(p.x, p.y, segments, epsilon);
    RC_ASSERT(knots == insert_one_by_one(p.x, p.y, segments, epsilon));
    RC_ASSERT(knots.size() + 1 <= segments);
}

RC_GTEST_PROP(DouglasPeucker, LeavesNothingFartherThanEpsilon, ()) {
    const auto n = *rc::gen::inRange<std::size_t>(2, 200);
    const auto p = random_polyline(*rc::gen::inRange<std::uint64_t>(0, 1u << 30), n, true);
    const double epsilon = *rc::gen::inRange(1, 1000) * 1e-3;
    Knots ends = douglas_peucker(p.x, p.y, kUnlimited, epsilon);
    ends.insert(ends.begin(), 0);
    ends.push_back(static_cast<std::uint32_t>(n - 1));
    for (std::size_t k = 0; k + 1 < ends.size(); ++k)
        for (std::size_t i = ends[k] + 1; i < ends[k + 1]; ++i)
            RC_ASSERT(deviation(p.x, p.y, ends[k], ends[k + 1], i) <= epsilon);
}

// Abscissae and ordinates that are small integers over a power of two, so that equal deviations are equal.
const Points kNine{0, 1, 2, 3, 4, 5, 6, 7, 8};

TEST(DouglasPeucker, TakesTheLeftmostOfEquallyFarPoints) {
    const Points tent{0, 0, 1, 0, 0, 0, 1, 0, 0}; // points 2 and 6 are equally far
    EXPECT_EQ(douglas_peucker(kNine, tent, 2, 0.0), Knots{2});
    const Points plateau{0, 0, 0, 1, 1, 1, 0, 0, 0};
    EXPECT_EQ(douglas_peucker(kNine, plateau, 2, 0.0), Knots{3});
}

TEST(DouglasPeucker, TakesTheLeftmostOfEquallyFarSpans) {
    // The middle goes first; then points 2 and 6 deviate equally from the two halves.
    const Points peaks{0, 0, 2, 0, 8, 0, 2, 0, 0};
    const Points at_middle{0, 2, 4, 6, 8, 6, 4, 2, 0};
    EXPECT_EQ(douglas_peucker(kNine, at_middle, 9, 0.0), Knots{4});
    Points dents = at_middle;
    dents[2] -= 1.0, dents[6] -= 1.0;
    EXPECT_EQ(douglas_peucker(kNine, dents, 2, 0.0), Knots{4});
    EXPECT_EQ(douglas_peucker(kNine, dents, 3, 0.0), (Knots{2, 4}));
    EXPECT_EQ(douglas_peucker(kNine, dents, 4, 0.0), (Knots{2, 4, 6}));
    EXPECT_EQ(douglas_peucker(kNine, peaks, 9, 0.0), insert_one_by_one(kNine, peaks, 9, 0.0));
}

TEST(DouglasPeucker, EpsilonIsTheLargestDeviationThatMayStay) {
    Points bump(9, 0.0);
    bump[4] = 0.5;
    EXPECT_EQ(douglas_peucker(kNine, bump, 9, 0.5), Knots{});
    const Knots knots = douglas_peucker(kNine, bump, 2, std::nextafter(0.5, 0.0));
    EXPECT_EQ(knots, Knots{4});
}

TEST(DouglasPeucker, NeedsNoKnotOnAStraightLine) {
    EXPECT_EQ(douglas_peucker(kNine, kNine, kUnlimited, 0.0), Knots{});
    EXPECT_EQ(douglas_peucker({0, 1}, {0, 1}, kUnlimited, 0.0), Knots{});
}

TEST(DouglasPeucker, MeasuresAlongYOnAnUnevenGrid) {
    // On the chord y = x / 8 the point (6, 1) deviates by 0.25 and (1, 0.25) by 0.125.
    EXPECT_EQ(douglas_peucker({0, 1, 6, 8}, {0, 0.25, 1, 1}, 2, 0.0), Knots{2});
}

TEST(DouglasPeucker, OneSegmentHasNoKnots) {
    const Polyline p = random_polyline(1, 50, true);
    EXPECT_TRUE(douglas_peucker(p.x, p.y, 1, 0.0).empty());
}

} // namespace
