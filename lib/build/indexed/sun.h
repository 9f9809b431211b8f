// The small bright body that moves from map to map: the sun, which a cone stands for.
#pragma once

#include "compress/target.h"

#include <acdf/layout.h>

#include <array>
#include <cstdint>
#include <vector>

namespace acdf::build {

/// A map as a renderer looks it up.
struct SunMap {
    const compress::Target* target = nullptr; ///< what is fitted
    const compress::Target* texels = nullptr; ///< of one channel and nearest lookup, on the same grid
    AcdfFilter filter = ACDF_FILTER_BILINEAR;
};

using SunDirection = std::array<double, 3>;

/// The sun of all maps.
struct Suns {
    std::uint32_t roots = 0;              ///< of the cones' profile (acdf/indexed/cone.h)
    bool any = false;                     ///< whether any map has one
    std::vector<AcdfMap> of_maps;         ///< one a map; `share` is not set. Without sun_share where there is none
    std::vector<std::vector<float>> rest; ///< one a map: its target without the sun
};

/// Finds the sun of each map: a region a few degrees wide at most. Its brightest texel is kSunContrast times its
/// surroundings, and four times the brightest elsewhere. None where fewer than half of the maps have one. `given`:
/// where it is, one a map, where that is known; zeros where it is not up. `counts`: of maps along each axis.
Suns find_suns(const std::vector<SunMap>& maps, const std::vector<std::uint32_t>& counts,
               const std::vector<SunDirection>* given);
/// None.
Suns no_suns(const std::vector<SunMap>& maps);

constexpr double kSunContrast = 16.0;

} // namespace acdf::build
