// How far the pdf at some coordinates of an indexed environment is from a map.
#pragma once

#include "build/indexed/sun.h"

#include <acdf/accuracy.h>
#include <acdf/indexed/views.h>

namespace acdf::build {

/// The map is on the grid of the file.
builder::MapAccuracy measure_mixed(const MixedEnvironment& environment, const SunMap& map);

} // namespace acdf::build
