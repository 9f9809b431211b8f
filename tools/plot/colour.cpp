#include "tools/plot/colour.h"

#include "images/module.h"

#include <tbb/parallel_for.h>

#include <cmath>
#include <stdexcept>

namespace acdf::tools {
namespace {

// "Turbo" (A. Mikhailov, "Turbo, an improved rainbow colormap for visualization", 2019) without its ends, where it
// fades to near-black: the largest density shall be red, not brown, and the smallest no neighbour of zero_colour.
constexpr double first_colour = 0.05, last_colour = 0.91;

// sRGB; the ends are equally dark.
const std::vector<float> diverging_knots = {0.16f, 0.33f, 0.66f, 0.93f, 0.93f, 0.91f, 0.70f, 0.15f, 0.17f};

images::Picture colours(const images::Picture& position, ColourMap map) {
    images::Picture out;
    std::string error;
    const std::vector<float> knots = map == ColourMap::rainbow ? std::vector<float>() : diverging_knots;
    if (!images::module().colour_map(position, "turbo", knots, out, error))
        throw std::runtime_error("cannot make colours: " + error);
    return out;
}

} // namespace

float linear_to_srgb(float linear) {
    return linear <= 0.0031308f ? 12.92f * linear : 1.055f * std::pow(linear, 1.0f / 2.4f) - 0.055f;
}

images::Picture false_colour(const DensityImage& image, const DensityRange& range, ColourMap map) {
    const double first = map == ColourMap::rainbow ? first_colour : 0.0,
                 last = map == ColourMap::rainbow ? last_colour : 1.0;
    const int width = image.map.width, height = image.map.height;
    images::Picture scalar(width, height, 1);
    tbb::parallel_for(std::size_t{0}, image.density.size(), [&](std::size_t i) {
        const double density = static_cast<double>(image.density[i]);
        const double t = density > 0.0 ? range.position(density) : 0.0;
        scalar.values[i] = static_cast<float>(first + t * (last - first));
    });
    images::Picture colour = colours(scalar, map);
    tbb::parallel_for(std::size_t{0}, image.density.size(), [&](std::size_t i) {
        const float density = image.density[i];
        for (std::size_t c = 0; c < 3; ++c) {
            float& value = colour.values[3 * i + c];
            if (density > 0.0f && map == ColourMap::rainbow)
                value = linear_to_srgb(value); // OpenImageIO's colour maps are linear light
            else if (!(density > 0.0f)) value = density == 0.0f ? zero_colour[c] : background[c];
        }
    });
    return colour;
}

} // namespace acdf::tools
