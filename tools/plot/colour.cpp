#include "tools/plot/colour.h"

#include <OpenImageIO/color.h>
#include <OpenImageIO/imagebufalgo.h>
#include <tbb/parallel_for.h>

#include <stdexcept>

namespace acdf::tools {
namespace {

// "Turbo" (A. Mikhailov, "Turbo, an improved rainbow colormap for visualization", 2019) without its ends, where it
// fades to near-black: the largest density shall be red, not brown, and the smallest no neighbour of zero_colour.
constexpr double first_colour = 0.05, last_colour = 0.91;

// sRGB; the ends are equally dark.
constexpr std::array<float, 9> diverging_knots = {0.16f, 0.33f, 0.66f, 0.93f, 0.93f, 0.91f, 0.70f, 0.15f, 0.17f};

OIIO::ImageBuf colours(const OIIO::ImageBuf& position, ColourMap map) {
    if (map == ColourMap::rainbow) return OIIO::ImageBufAlgo::color_map(position, 0, "turbo");
    return OIIO::ImageBufAlgo::color_map(position, 0, 3, 3, diverging_knots);
}

} // namespace

OIIO::ImageBuf false_colour(const DensityImage& image, const DensityRange& range, ColourMap map) {
    const double first = map == ColourMap::rainbow ? first_colour : 0.0,
                 last = map == ColourMap::rainbow ? last_colour : 1.0;
    const int width = image.map.width, height = image.map.height;
    OIIO::ImageBuf scalar(OIIO::ImageSpec(width, height, 1, OIIO::TypeFloat));
    auto* position = static_cast<float*>(scalar.localpixels());
    tbb::parallel_for(std::size_t{0}, image.density.size(), [&](std::size_t i) {
        const double density = static_cast<double>(image.density[i]);
        const double t = density > 0.0 ? range.position(density) : 0.0;
        position[i] = static_cast<float>(first + t * (last - first));
    });
    OIIO::ImageBuf colour = colours(scalar, map);
    if (colour.has_error()) throw std::runtime_error("cannot make colours: " + colour.geterror());

    auto* rgb = static_cast<float*>(colour.localpixels());
    tbb::parallel_for(std::size_t{0}, image.density.size(), [&](std::size_t i) {
        const float density = image.density[i];
        for (std::size_t c = 0; c < 3; ++c) {
            float& value = rgb[3 * i + c];
            if (density > 0.0f && map == ColourMap::rainbow)
                value = OIIO::linear_to_sRGB(value); // OpenImageIO's colour maps are linear light
            else if (!(density > 0.0f)) value = density == 0.0f ? zero_colour[c] : background[c];
        }
    });
    return colour;
}

} // namespace acdf::tools
