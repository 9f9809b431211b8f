// The portals of a scene for files with visibility cells.
#pragma once

#include "measure/scenes/scene.h"

#include <acdf/builder.h>

namespace acdf::tools {

/// A rectangle in the frame of directions as one in the scene's own coordinates, which `visibility` tells.
builder::Portal portal_of(const builder::Visibility& visibility, const measure::Portal& portal);

} // namespace acdf::tools
