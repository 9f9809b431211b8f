// Densities over the sphere as images: what `acdf plot` turns into colours.
#pragma once

#include "build/projection.h"
#include "compress/target.h"
#include "tools/cli/progress.h"

#include <acdf/reader.h>

#include <functional>
#include <vector>

namespace acdf::tools {

/// Density in sr^-1 of a unit direction. Called from several threads.
using Density = std::function<float(const float direction[3])>;

/// The stored density, exactly. The view's File must outlive the result.
Density density_of(const EnvironmentView& view);

/// The density proportional to `target` at full resolution (nearest lookup). `target` must outlive the result and
/// have energy.
Density density_of(const compress::Target& target);

/// What pixels outside of the disc of an angular map hold.
constexpr float shows_nothing = -1.0f;

/// A density at the centres of the pixels of `map`.
struct DensityImage {
    build::Map map;
    std::vector<float> density; ///< height x width, sr^-1, or shows_nothing

    float at(int x, int y) const {
        return density[static_cast<std::size_t>(y) * static_cast<std::size_t>(map.width) +
                       static_cast<std::size_t>(x)];
    }
};

/// A map as wide as told: lat-long (half as high) or angular (square).
build::Map plot_map(build::Layout layout, int width);

/// The direction at image position (x, y) in pixels; pixel centres are at halves. False outside of the disc.
bool pixel_direction(const build::Map& map, double x, double y, float direction[3]);

DensityImage draw_density(const build::Map& map, const Density& density, const build::Progress& progress = {});

} // namespace acdf::tools
