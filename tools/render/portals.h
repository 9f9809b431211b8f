// The portals of a scene for files of places.
#pragma once

#include "measure/scenes/scene.h"

#include <acdf/builder.h>

namespace acdf::tools {

/// A rectangle in the frame of directions as one in the scene's own coordinates, which `places` tells.
builder::Portal told_portal(const builder::Places& places, const measure::Portal& portal);

} // namespace acdf::tools
