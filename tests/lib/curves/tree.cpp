// Trees of curves: cells against the slow decoder, and pdfs of tilted ones.
#include "tests/inputs/sanitized.h"
#include "tests/lib/reader/reference.h"
#include "tests/lib/reader/sampling.h"

#include <acdf/curves/tree.h>

#include <algorithm>
#include <cmath>

using namespace acdf_test;
using acdf_reference::Cell;
using acdf_reference::Environment;

namespace {

void expect_same_cell(double p, const AcdfTiltedRange (&range)[2], const Cell& cell) {
    ASSERT_EQ(p, cell.p);
    if (p == 0.0) return;
    for (int axis = 0; axis < 2; ++axis) {
        ASSERT_EQ(range[axis].low, cell.low[axis]);
        ASSERT_EQ(range[axis].high, cell.high[axis]);
        ASSERT_EQ(range[axis].tilt, cell.tilt[axis]);
    }
}

// To the bit: SPEC.md says in which order the products are formed.
TEST(Tree, cellsAreThoseOfTheSlowDecoder) {
    for (std::uint32_t seed = 0; seed < tree_count; ++seed) {
        const RandomOptions options = options_of(seed);
        const auto env = loaded(RandomTree(seed, options).make());
        const Environment reference(env->bytes);
        const AcdfEnvironment& data = env->view.data();
        std::mt19937_64 rng(seed);
        for (int n = 0; n < 300; ++n) {
            const double u[2] = {uniform(rng), uniform(rng)};
            double left[2] = {u[0], u[1]};
            AcdfTiltedRange range[2] = {acdf_whole_axis(options.columns), acdf_whole_axis(options.rows)};
            const double p = acdf_tree_sample(data.tree, data.root, left, range);
            expect_same_cell(p, range, reference.sample(u[0], u[1]).cell);
            const std::uint32_t square[2] = {static_cast<std::uint32_t>(u[0] * options.columns),
                                             static_cast<std::uint32_t>(u[1] * options.rows)};
            AcdfTiltedRange found[2] = {acdf_whole_axis(options.columns), acdf_whole_axis(options.rows)};
            const double q = acdf_tree_find(data.tree, data.root, square, found, nullptr);
            expect_same_cell(q, found, reference.find({double(square[0]), double(square[1])}));
            if (HasFatalFailure()) FAIL() << "seed " << seed << ", sample " << n;
        }
    }
}

// Few and many values, each width: the count of those that are not above the key.
TEST(Tree, upperBoundCounts) {
    std::mt19937 rng(1);
    for (std::uint32_t count = 0; count < 200; ++count)
        for (std::uint32_t code = 0; code < 3; ++code) {
            std::vector<std::uint32_t> values(count);
            for (std::uint32_t& v : values)
                v = static_cast<std::uint32_t>(rng()) >> (code == 0 ? 24 : code == 1 ? 16 : 0);
            std::sort(values.begin(), values.end());
            Bytes bytes;
            for (std::uint32_t v : values) put(bytes, v, 1 << code);
            const Exact array(bytes); // so that a sanitizer sees a value read behind the last
            for (int n = 0; n < 50; ++n) {
                const std::uint32_t key = n == 0   ? 0
                                          : n == 1 ? 0xFFFFFFFF
                                                   : static_cast<std::uint32_t>(rng()) >> (code == 0   ? 24
                                                                                           : code == 1 ? 16
                                                                                                       : 0);
                const auto expected = std::upper_bound(values.begin(), values.end(), key) - values.begin();
                ASSERT_EQ(acdf_upper_bound(array.data(), count, code, key), expected) << count << ' ' << code;
            }
        }
}

TEST(EnvironmentView, pdfOfATiltedSampleAgrees) {
    for (std::uint32_t seed = 0; seed < tree_count; ++seed) {
        const auto env = loaded(RandomTree(seed, options_of(seed)).make());
        std::mt19937_64 rng(seed);
        for (int n = 0; n < 1000; ++n) {
            const auto s = env->view.sample(uniform(rng), uniform(rng));
            // Where a pdf falls to 2^-15 of its mean across a cell of one step of 1024, rounding moves it.
            ASSERT_NEAR(env->view.pdf(s.direction) / s.pdf, 1.0, 2e-2) << seed << ' ' << n;
        }
    }
}

// 64 curves whose first segment has probability 2^-32: the product leaves the range of double.
TEST(EnvironmentView, aVanishingProbabilityStaysPositive) {
    EnvironmentSpec spec;
    spec.columns = 65536;
    spec.rows = 2;
    for (int i = 0; i < 64; ++i) {
        CurveSpec curve = even_curve(0, {65535u - static_cast<std::uint32_t>(i)});
        curve.cumulative_bytes = 4;
        curve.cumulative = {1};
        curve.link_bytes = i < 63 ? 1 : 0;
        curve.children = {i + 1, -1};
        spec.tree.curves.resize(static_cast<std::size_t>(i) + 1);
        spec.tree.curves.back() = curve;
    }
    const auto env = loaded(spec);
    const auto s = env->view.sample(0.0, 0.5);
    EXPECT_TRUE(std::isfinite(s.pdf) && s.pdf > 0.0f);
    EXPECT_EQ(env->view.pdf(s.direction), s.pdf);
}

} // namespace
