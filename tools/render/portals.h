// The portals of a scene for files with visibility cells.
#pragma once

#include "measure/scenes/scene.h"

#include <acdf/builder.h>

namespace acdf::tools {

/// Transforms a rectangle from the frame of directions to the scene's own coordinates, by the transform of
/// `visibility`.
builder::Portal portal_of(const builder::Visibility& visibility, const measure::Portal& portal);

} // namespace acdf::tools
