#include "input/probe/detect.h"

#include "build/probe/cube.h"
#include "input/error.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace acdf::input {
namespace {

// ---- shapes -----------------------------------------------------------------------------------------

bool has_ratio(const Image& image, int across, int down) {
    return image.width % across == 0 && image.width / across * down == image.height;
}

bool is_square(const Image& image) { return has_ratio(image, 1, 1); }

std::string shape(const Image& image) { return std::to_string(image.width) + "x" + std::to_string(image.height); }

// ---- what is left black -----------------------------------------------------------------------------

const float* texel(const Image& image, int x, int y) {
    return image.rgb.data() +
           3 * (static_cast<std::size_t>(y) * static_cast<std::size_t>(image.width) + static_cast<std::size_t>(x));
}

double brightness(const Image& image, int x, int y) {
    const float* rgb = texel(image, x, y);
    return std::max({rgb[0], rgb[1], rgb[2]});
}

// Black: a thousandth of what is typical, for lossy compression. Roots, so that a sun does not set the level.
double black_level(const Image& image) {
    double sum = 0.0;
    for (int y = 0; y < image.height; ++y) {
        double row = 0.0;
        for (int x = 0; x < image.width; ++x) row += std::sqrt(brightness(image, x, y));
        sum += row / image.width;
    }
    const double root = sum / image.height;
    return 1e-3 * root * root;
}

// Share of black texels among those that `select` picks; 0 where it picks none.
template <typename Select>
double black_share(const Image& image, Select&& select) {
    const double level = black_level(image);
    std::uint64_t black = 0, all = 0;
    for (int y = 0; y < image.height; ++y)
        for (int x = 0; x < image.width; ++x) {
            if (!select(x, y)) continue;
            ++all;
            black += brightness(image, x, y) <= level;
        }
    return all ? static_cast<double>(black) / static_cast<double>(all) : 0.0;
}

// A credit line may stand in the unused part, so nine tenths will do; more than half of what is used must show
// something, or black proves nothing.
constexpr double mostly = 0.9, hardly = 0.5;

bool is_cross(const Image& image, build::Layout layout) {
    const build::Map map{layout, image.width, image.height};
    return black_share(image, [&](int x, int y) { return !on_cube_face(map, x, y); }) >= mostly &&
           black_share(image, [&](int x, int y) { return on_cube_face(map, x, y); }) <= hardly;
}

double radius(const Image& image, int x, int y) {
    return std::hypot((2.0 * x + 1.0) / image.width - 1.0, (2.0 * y + 1.0) / image.height - 1.0);
}

bool is_disc(const Image& image) {
    const double texel_size = 2.0 / image.width;
    const auto corner = [&](int x, int y) { return radius(image, x, y) > 1.0 + texel_size; };
    const auto rim = [&](int x, int y) {
        const double r = radius(image, x, y);
        return r < 1.0 - texel_size && r > 0.9;
    };
    return black_share(image, corner) >= mostly && black_share(image, rim) <= hardly;
}

// ---- octahedral maps: each border is folded at its middle, so its halves show the same directions -----

// Log brightness of texel i of border 0..3, `inward` texels from it.
double border(const Image& image, double level, int side, int i, int inward) {
    const int last = image.width - 1;
    const int x[4] = {i, last - inward, i, inward}, y[4] = {inward, i, last - inward, i};
    return std::log(brightness(image, x[side], y[side]) + level);
}

bool is_octahedral(const Image& image) {
    const int n = image.width;
    if (n < 16 || n % 2 != 0) return false;
    const double level = black_level(image);
    // Sums of differences between texels that touch across the fold, that touch within the image, and that are
    // far apart on the border. Near the fold's middle all are neighbours, which proves nothing.
    const int half = n / 2 - n / 16;
    double folded = 0.0, touching = 0.0, apart = 0.0;
    for (int side = 0; side < 4; ++side)
        for (int i = 0; i < half; ++i) {
            const double here = border(image, level, side, i, 0);
            folded += std::abs(here - border(image, level, side, n - 1 - i, 0));
            touching += std::abs(here - border(image, level, side, i, 1));
            apart += std::abs(here - border(image, level, side, (i + half / 2) % half, 0));
        }
    return folded <= 1.5 * touching && folded < 0.5 * apart;
}

// ---- decisions --------------------------------------------------------------------------------------

[[noreturn]] void refuse(const std::string& path, const Image& image, const std::string& what) {
    throw input_error(path, shape(image) + " " + what);
}

build::Layout cube_layout(const std::string& path, const Image& image) {
    for (const build::Layout layout :
         {build::Layout::vertical_cross, build::Layout::horizontal_cross, build::Layout::stacked_cube})
        if (build::has_shape({layout, image.width, image.height})) return layout;
    refuse(path, image, "is no cube cross (3:4 or 4:3) and no column of faces (1:6); crop it, or set --projection");
}

Detected as_asked(const std::string& path, const Image& image, Projection projection) {
    const std::string reason = std::string("--projection ") + to_string(projection);
    if (projection == Projection::latlong) return {build::Layout::latlong, reason};
    if (projection == Projection::cube_cross) return {cube_layout(path, image), reason};
    if (!is_square(image))
        refuse(path, image,
               std::string("is not square, as ") + to_string(projection) +
                   " is; crop it to the disc or the square, or set another --projection");
    if (projection == Projection::angular) return {build::Layout::angular, reason};
    if (projection == Projection::mirrorball) return {build::Layout::mirrorball, reason};
    return {build::Layout::octahedral, reason};
}

Detected by_tag(const std::string& path, const Image& image) {
    if (image.tag == EnvironmentTag::latlong)
        return {build::Layout::latlong, "the file says so (OpenEXR envmap attribute or texture format)"};
    if (!has_ratio(image, 1, 6))
        refuse(path, image, "says it is a cube map, but is not 1:6 as OpenEXR's are; set --projection");
    return {build::Layout::stacked_cube, "the file says so (OpenEXR envmap attribute)"};
}

Detected by_shape(const std::string& path, const Image& image) {
    if (has_ratio(image, 2, 1)) return {build::Layout::latlong, "2:1 shape"};
    for (const build::Layout layout : {build::Layout::vertical_cross, build::Layout::horizontal_cross}) {
        const bool vertical = layout == build::Layout::vertical_cross;
        if (!has_ratio(image, vertical ? 3 : 4, vertical ? 4 : 3)) continue;
        if (is_cross(image, layout))
            return {layout, vertical ? "3:4 shape, black beside the cross" : "4:3 shape, black beside the cross"};
        refuse(path, image,
               "has the shape of a cube cross but is not black beside it; "
               "if it is one, set --projection cube-cross");
    }
    if (has_ratio(image, 1, 6))
        refuse(path, image,
               "may be six cube faces, but no envmap attribute says so; set --projection cube-cross "
               "for OpenEXR's order (+X -X +Y -Y +Z -Z)");
    if (is_square(image) && is_octahedral(image) && !is_disc(image))
        return {build::Layout::octahedral, "square, and the borders match when folded"};
    if (is_square(image) && is_disc(image))
        refuse(path, image,
               "with black corners is an angular map or a mirror ball, and nothing in the image tells "
               "which; set --projection angular (as Debevec's light probes) or --projection mirrorball");
    if (is_square(image))
        refuse(path, image,
               "is square, but neither a disc with black corners nor a seamless octahedral map; "
               "set --projection angular, mirrorball or octahedral");
    refuse(path, image,
           "has the shape of no known projection (lat-long is 2:1, cubes 3:4 or 4:3, discs and "
           "octahedral 1:1); crop it, or set --projection");
}

} // namespace

Detected detect_layout(const std::string& path, const Image& image, Projection projection) {
    if (projection != Projection::automatic) return as_asked(path, image, projection);
    return image.tag != EnvironmentTag::none ? by_tag(path, image) : by_shape(path, image);
}

bool is_latlong(const Image& image, Projection projection) {
    if (projection != Projection::automatic) return projection == Projection::latlong;
    return image.tag == EnvironmentTag::latlong || (image.tag == EnvironmentTag::none && has_ratio(image, 2, 1));
}

Projection projection_of(build::Layout layout) {
    switch (layout) {
    case build::Layout::latlong:
        return Projection::latlong;
    case build::Layout::angular:
        return Projection::angular;
    case build::Layout::mirrorball:
        return Projection::mirrorball;
    case build::Layout::octahedral:
        return Projection::octahedral;
    default:
        return Projection::cube_cross;
    }
}

} // namespace acdf::input
