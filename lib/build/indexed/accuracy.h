// How far the pdf at some coordinates of an indexed environment is from a map.
#pragma once

#include "build/indexed/sun.h"

#include <acdf/views.h>

#include <cstdint>

namespace acdf::build {

/// As in acdf/accuracy.h. By summation over texels; near the sun over 64 points of each.
struct IndexedAccuracy {
    double relative_variance = 0.0;
    double max_weight = 0.0;
    std::uint64_t support_violations = 0;
    double total = 0.0; ///< of the map
};

/// The map is on the grid of the file.
IndexedAccuracy measure_mixed(const MixedEnvironment& environment, const SunMap& map);

} // namespace acdf::build
