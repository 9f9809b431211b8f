// How many knots a row needs: errors against sums by hand, and where adaptive knots must gain.
#include "tests/inputs/synthetic.h"

#include "measure/scanline.h"

#include <gtest/gtest.h>

#include <stdexcept>

namespace {

using namespace acdf::measure;
using namespace acdf_test;
using acdf::compress::Curve;
using acdf::compress::Target;

/// One row of so many texels.
Target row_of(std::uint32_t columns, const std::function<double(std::uint32_t)>& f) {
    return texel_target(columns, 1, [&](std::uint32_t c, std::uint32_t) { return f(c); });
}

TEST(Scanline, ErrorOfSegmentsIsTheSumByHand) {
    // Pdfs 0, 2, 1, 1 of mean 1: one segment is wrong by 1, 1, 0, 0; two by 1, 1, 0, 0; four by nothing.
    const Scanline line(row_of(4, [](std::uint32_t c) { return c == 0 ? 0.0 : c == 1 ? 2.0 : 1.0; }), 0);
    EXPECT_NEAR(line.rms_error(line.fit(ACDF_FIT_UNIFORM, 1)), std::sqrt(0.5), 1e-12);
    EXPECT_NEAR(line.rms_error(line.fit(ACDF_FIT_UNIFORM, 2)), std::sqrt(0.5), 1e-12);
    EXPECT_NEAR(line.rms_error(line.fit(ACDF_FIT_UNIFORM, 4)), 0.0, 1e-12);
    EXPECT_NEAR(line.contrast(), 0.5, 1e-12);
    EXPECT_EQ(line.uniform_segments(0.8), 1u);
    EXPECT_EQ(line.uniform_segments(0.7), 3u); // segments 0, 1, 2-3
    EXPECT_NEAR(line.rms_error(line.fit(ACDF_FIT_UNIFORM, 3)), 0.0, 1e-12);
}

TEST(Scanline, ErrorOfTiltedSegmentsIsThatOfManySmallSteps) {
    const std::uint32_t columns = 60;
    const Scanline line(row_of(columns, [](std::uint32_t c) { return 1.0 + std::sin(0.2 * c) * 0.8; }), 0);
    const Curve curve = line.fit(ACDF_FIT_PDF, 7);
    ASSERT_EQ(curve.tilts.size(), curve.segments());
    double total = 0.0;
    for (std::uint32_t c = 0; c < columns; ++c) total += 1.0 + std::sin(0.2 * c) * 0.8;
    double sum = 0.0;
    constexpr int steps = 400; // a texel
    for (std::uint32_t c = 0; c < columns; ++c) {
        std::size_t s = 0;
        while (s < curve.knots.size() && curve.knots[s] <= c) ++s;
        const double begin = s > 0 ? curve.knots[s - 1] : 0.0,
                     end = s < curve.knots.size() ? curve.knots[s] : columns;
        for (int i = 0; i < steps; ++i) {
            const double t = (c + (i + 0.5) / steps - begin) / (end - begin);
            const double p =
                curve.probability[s] * columns / (end - begin) * (1.0 + curve.tilts[s] * (2.0 * t - 1.0));
            const double exact = (1.0 + std::sin(0.2 * c) * 0.8) * columns / total;
            sum += (p - exact) * (p - exact) / (double(columns) * steps);
        }
    }
    EXPECT_NEAR(line.rms_error(curve), std::sqrt(sum), 1e-6);
}

TEST(Scanline, AdaptiveKnotsGainMuchOnAPeakAndLittleOnASmoothRow) {
    const Scanline peaky(row_of(1024, [](std::uint32_t c) { return c >= 500 && c < 503 ? 400.0 : 1.0; }), 0);
    const Scanline smooth(row_of(1024, [](std::uint32_t c) { return 2.0 + std::sin(2.0 * kPi * c / 1024.0); }), 0);
    // Three segments are exact; of equally spaced ones none smaller than a texel has a border at 500 and 503.
    const KnotGain exact = knot_gain(peaky, ACDF_FIT_CDF, 3);
    EXPECT_NEAR(exact.rms_error, 0.0, 1e-6);
    EXPECT_EQ(exact.segments, 3u);
    const KnotGain modest = knot_gain(smooth, ACDF_FIT_CDF, 16);
    EXPECT_LT(modest.factor(), 2.0);
    EXPECT_GT(modest.factor(), 0.8);
    const double one_less = peaky.rms_error(peaky.fit(ACDF_FIT_CDF, 2)); // one border of the peak
    EXPECT_GT(peaky.uniform_segments(0.1 * one_less), 100u);
    // Linear segments follow a smooth row with far fewer knots.
    EXPECT_GT(knot_gain(smooth, ACDF_FIT_PDF, 16).factor(), 5.0);
}

TEST(Scanline, EqualErrorIsThatOfTheFewestSegments) {
    const Target t = noise_target(200, 8, 3);
    const Scanline line(t, 5);
    for (const std::uint32_t segments : {3u, 20u, 90u}) {
        const KnotGain gain = knot_gain(line, ACDF_FIT_CDF, segments);
        EXPECT_LE(line.rms_error(line.fit(ACDF_FIT_UNIFORM, gain.uniform_segments)), gain.rms_error);
        for (std::uint32_t fewer = 1; fewer < gain.uniform_segments; ++fewer)
            ASSERT_GT(line.rms_error(line.fit(ACDF_FIT_UNIFORM, fewer)), gain.rms_error);
        EXPECT_DOUBLE_EQ(gain.factor(), (gain.uniform_segments + 1.0) / (gain.segments + 1.0));
    }
}

TEST(Scanline, RowsAreChosenByContrastAwayFromThePoles) {
    // Contrast grows with the row; the poles are constant and black.
    const Target t = texel_target(32, 16, [](std::uint32_t c, std::uint32_t r) {
        return r == 0 ? 1.0 : r == 15 ? 0.0 : c == 4 ? 1.0 + r : 1.0;
    });
    EXPECT_EQ(choose_row(t, RowChoice::smooth), 4u);
    EXPECT_EQ(choose_row(t, RowChoice::peaky), 11u);
    const Target black = sphere_target(8, 8, [](double, double) { return 0.0; });
    EXPECT_THROW(choose_row(black, RowChoice::peaky), std::invalid_argument);
    EXPECT_THROW(Scanline(t, 15), std::invalid_argument);
    EXPECT_THROW(Scanline(t, 16), std::invalid_argument);
}

} // namespace
