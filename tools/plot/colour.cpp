#include "tools/plot/colour.h"
#include "compress/parallel.h"

#include <algorithm>
#include <cmath>
#include <vector>

namespace acdf::tools {
namespace {

/// Evenly spaced colours of a map, sRGB, with straight lines between them.
using Knots = std::vector<Colour>;

// The spectrum backwards, in steps that look about as large: from one knot to the next 0.12 to 0.18 in Oklab (B.
// Ottosson, 2020). Hue falls all the way. Lightness rises to yellow and falls to a red as dark as blue, so that
// neither end is a neighbour of zero_colour.
const Knots rainbow_knots = {{0.34f, 0.14f, 0.60f}, {0.24f, 0.36f, 0.92f}, {0.10f, 0.60f, 0.92f},
                             {0.08f, 0.76f, 0.72f}, {0.34f, 0.86f, 0.36f}, {0.80f, 0.88f, 0.20f},
                             {0.98f, 0.66f, 0.14f}, {0.92f, 0.38f, 0.08f}, {0.72f, 0.07f, 0.04f}};

// The ends are equally dark.
const Knots diverging_knots = {{0.16f, 0.33f, 0.66f}, {0.93f, 0.93f, 0.91f}, {0.70f, 0.15f, 0.17f}};

/// At `t` in [0, 1].
Colour colour_at(const Knots& knots, float t) {
    const float place = t * static_cast<float>(knots.size() - 1);
    const std::size_t below = std::min(static_cast<std::size_t>(place), knots.size() - 2);
    const float share = place - static_cast<float>(below);
    Colour out;
    for (std::size_t c = 0; c < out.size(); ++c)
        out[c] = knots[below][c] + share * (knots[below + 1][c] - knots[below][c]);
    return out;
}

} // namespace

float linear_to_srgb(float linear) {
    return linear <= 0.0031308f ? 12.92f * linear : 1.055f * std::pow(linear, 1.0f / 2.4f) - 0.055f;
}

images::Picture false_colour(const PdfImage& image, const PdfRange& range, ColourMap map) {
    const Knots& knots = map == ColourMap::rainbow ? rainbow_knots : diverging_knots;
    images::Picture picture(image.map.width, image.map.height);
    compress::parallel_for(std::size_t{0}, image.pdf.size(), [&](std::size_t i) {
        const float pdf = image.pdf[i];
        Colour colour = pdf == 0.0f ? zero_colour : background;
        if (pdf > 0.0f) colour = colour_at(knots, static_cast<float>(range.position(static_cast<double>(pdf))));
        std::copy(colour.begin(), colour.end(), picture.values.begin() + static_cast<std::ptrdiff_t>(3 * i));
    });
    return picture;
}

} // namespace acdf::tools
