// False colours: ordered as the densities are.
#include "tools/plot/colour.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace acdf::test {
namespace {

using tools::Colour;
using tools::DensityRange;

std::vector<Colour> colours_of(const std::vector<float>& densities, const DensityRange& range) {
    const tools::DensityImage image{{build::Layout::latlong, static_cast<int>(densities.size()), 1}, densities};
    const std::vector<float> rgb = tools::false_colour(image, range).values;
    std::vector<Colour> out(densities.size());
    for (std::size_t i = 0; i < out.size(); ++i) out[i] = {rgb[3 * i], rgb[3 * i + 1], rgb[3 * i + 2]};
    return out;
}

std::vector<float> ramp(int n, double low, double high) {
    std::vector<float> out;
    for (int i = 0; i < n; ++i) out.push_back(static_cast<float>(low * std::pow(high / low, i / (n - 1.0))));
    return out;
}

// Degrees: red 0, yellow 60, green 120, blue 240.
double hue(const Colour& c) {
    const double high = *std::max_element(c.begin(), c.end()), low = *std::min_element(c.begin(), c.end());
    const double r = c[0], g = c[1], b = c[2], span = high - low;
    if (high == r) return 60.0 * (g - b) / span;
    if (high == g) return 60.0 * (2.0 + (b - r) / span);
    return 60.0 * (4.0 + (r - g) / span);
}

TEST(PlotColours, RunFromVioletToRedWithoutTurningBack) {
    const std::vector<Colour> colours = colours_of(ramp(200, 1e-3, 1e2), {1e-3, 1e2});
    EXPECT_GT(hue(colours.front()), 230.0);
    EXPECT_LT(hue(colours.back()), 20.0);
    EXPECT_GT(colours.back()[0], 0.7f);
    // Turbo's hue stalls within its blue by a degree or two; it must never run back by more.
    double least = 360.0;
    for (const Colour& c : colours) {
        EXPECT_LT(hue(c), least + 2.0);
        least = std::min(least, hue(c));
    }
}

TEST(PlotColours, DifferByStepsThatOneCanSee) {
    const std::vector<Colour> colours = colours_of(ramp(32, 1e-3, 1e2), {1e-3, 1e2});
    for (std::size_t i = 1; i < colours.size(); ++i) {
        double square = 0.0;
        for (std::size_t c = 0; c < 3; ++c) square += std::pow(colours[i][c] - colours[i - 1][c], 2.0f);
        EXPECT_GT(std::sqrt(square), 0.04) << i;
    }
}

TEST(PlotColours, FollowTheLogarithmOfTheDensity) {
    const auto a = colours_of({1e-1f}, {1e-3, 1e1}), b = colours_of({1e2f}, {1.0, 1e4});
    for (std::size_t c = 0; c < 3; ++c) EXPECT_NEAR(a[0][c], b[0][c], 1e-4f);
}

TEST(PlotColours, OutsideOfTheRangeAreThoseOfItsEnds) {
    const auto c = colours_of({1e-9f, 1e-3f, 1e2f, 1e9f}, {1e-3, 1e2});
    EXPECT_EQ(c[0], c[1]);
    EXPECT_EQ(c[2], c[3]);
    EXPECT_NE(c[1], c[2]);
}

TEST(PlotColours, ZeroIsGreyUnlikeAnyDensityAndOutsideIsBackground) {
    const auto special = colours_of({0.0f, tools::shows_nothing}, {1e-3, 1e2});
    EXPECT_EQ(special[0], tools::zero_colour);
    EXPECT_EQ(special[1], tools::background);
    for (const Colour& c : colours_of(ramp(200, 1e-3, 1e2), {1e-3, 1e2}))
        EXPECT_GT(*std::max_element(c.begin(), c.end()) - *std::min_element(c.begin(), c.end()), 0.2f); // no grey
}

} // namespace
} // namespace acdf::test
