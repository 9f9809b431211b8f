// False colours: ordered as the pdfs are.
#include "tools/plot/colour.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>

namespace acdf::test {
namespace {

using tools::Colour;
using tools::PdfRange;

std::vector<Colour> colours_of(const std::vector<float>& pdfs, const PdfRange& range) {
    const tools::PdfImage image{{build::Layout::latlong, static_cast<int>(pdfs.size()), 1}, pdfs};
    const std::vector<float> rgb = tools::false_colour(image, range).values;
    std::vector<Colour> out(pdfs.size());
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
    for (std::size_t i = 1; i < colours.size(); ++i) EXPECT_LT(hue(colours[i]), hue(colours[i - 1]) - 0.1) << i;
}

TEST(PlotColours, DifferByStepsThatOneCanSee) {
    const std::vector<Colour> colours = colours_of(ramp(32, 1e-3, 1e2), {1e-3, 1e2});
    for (std::size_t i = 1; i < colours.size(); ++i) {
        double square = 0.0;
        for (std::size_t c = 0; c < 3; ++c) square += std::pow(colours[i][c] - colours[i - 1][c], 2.0f);
        EXPECT_GT(std::sqrt(square), 0.04) << i;
    }
}

// L, a, b of Oklab (B. Ottosson, "A perceptual color space for image processing", 2020), in which distances are
// about as large as they look.
std::array<double, 3> oklab(const Colour& c) {
    double linear[3];
    for (std::size_t k = 0; k < 3; ++k)
        linear[k] = c[k] <= 0.04045f ? c[k] / 12.92 : std::pow((static_cast<double>(c[k]) + 0.055) / 1.055, 2.4);
    const auto& [r, g, b] = linear;
    const double l = std::cbrt(0.4122214708 * r + 0.5363325363 * g + 0.0514459929 * b),
                 m = std::cbrt(0.2119034982 * r + 0.6806995451 * g + 0.1073969566 * b),
                 s = std::cbrt(0.0883024619 * r + 0.2817188376 * g + 0.6299787005 * b);
    return {0.2104542553 * l + 0.7936177850 * m - 0.0040720468 * s,
            1.9779984951 * l - 2.4285922050 * m + 0.4505937099 * s,
            0.0259040371 * l + 0.7827717662 * m - 0.8086757660 * s};
}

TEST(PlotColours, GoInStepsThatLookAboutAsLarge) {
    const std::vector<Colour> colours = colours_of(ramp(65, 1e-3, 1e2), {1e-3, 1e2}); // eight steps a knot
    double least = 1.0, largest = 0.0;
    for (std::size_t i = 1; i < colours.size(); ++i) {
        const auto a = oklab(colours[i - 1]), b = oklab(colours[i]);
        const double step = std::hypot(b[0] - a[0], b[1] - a[1], b[2] - a[2]);
        least = std::min(least, step);
        largest = std::max(largest, step);
    }
    EXPECT_LT(largest, 2.6 * least);
}

TEST(PlotColours, GrowLighterToYellowAndDarkerToRed) {
    const std::vector<Colour> colours = colours_of(ramp(200, 1e-3, 1e2), {1e-3, 1e2});
    std::vector<double> lightness;
    for (const Colour& c : colours) lightness.push_back(oklab(c)[0]);
    const auto peak = std::max_element(lightness.begin(), lightness.end());
    EXPECT_TRUE(std::is_sorted(lightness.begin(), peak + 1));
    EXPECT_TRUE(std::is_sorted(peak, lightness.end(), std::greater<>()));
    EXPECT_NEAR(hue(colours[static_cast<std::size_t>(peak - lightness.begin())]), 67.0, 15.0);
    const double zero = oklab(tools::zero_colour)[0]; // darker than all
    EXPECT_GT(lightness.front(), zero + 0.03);
    EXPECT_GT(lightness.back(), zero + 0.03);
}

TEST(PlotColours, OfRatiosAreLightInTheMiddleAndEquallyDarkAtTheEnds) {
    const tools::PdfImage image{{build::Layout::latlong, 3, 1}, {0.1f, 1.0f, 10.0f}};
    const std::vector<float> rgb = tools::false_colour(image, {0.1, 10.0}, tools::ColourMap::diverging).values;
    const auto at = [&](std::size_t i) { return oklab({rgb[3 * i], rgb[3 * i + 1], rgb[3 * i + 2]})[0]; };
    EXPECT_NEAR(at(0), at(2), 0.05);
    EXPECT_GT(at(1), at(0) + 0.3);
    EXPECT_GT(rgb[2], rgb[0]); // blue
    EXPECT_GT(rgb[6], rgb[8]); // red
}

TEST(PlotColours, FollowTheLogarithmOfThePdf) {
    const auto a = colours_of({1e-1f}, {1e-3, 1e1}), b = colours_of({1e2f}, {1.0, 1e4});
    for (std::size_t c = 0; c < 3; ++c) EXPECT_NEAR(a[0][c], b[0][c], 1e-4f);
}

TEST(PlotColours, OutsideOfTheRangeAreThoseOfItsEnds) {
    const auto c = colours_of({1e-9f, 1e-3f, 1e2f, 1e9f}, {1e-3, 1e2});
    EXPECT_EQ(c[0], c[1]);
    EXPECT_EQ(c[2], c[3]);
    EXPECT_NE(c[1], c[2]);
}

TEST(PlotColours, ZeroIsGreyUnlikeAnyPdfAndOutsideIsBackground) {
    const auto special = colours_of({0.0f, tools::shows_nothing}, {1e-3, 1e2});
    EXPECT_EQ(special[0], tools::zero_colour);
    EXPECT_EQ(special[1], tools::background);
    for (const Colour& c : colours_of(ramp(200, 1e-3, 1e2), {1e-3, 1e2}))
        EXPECT_GT(*std::max_element(c.begin(), c.end()) - *std::min_element(c.begin(), c.end()), 0.2f); // no grey
}

} // namespace
} // namespace acdf::test
