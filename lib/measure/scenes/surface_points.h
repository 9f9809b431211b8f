// Points all over the surfaces of a scene: where a file with visibility cells learns what they see.
#pragma once

#include "compress/visibility/light.h"
#include "measure/scenes/scene.h"

#include <cstdint>
#include <vector>

namespace acdf::measure {

/// Points on the objects of a geometry that are seen, each object with a share that grows as the root of its area,
/// so that small ones get theirs: the outer sides of closed shapes, both sides of planes; and what hides light
/// there. `geometry` must outlive it. The same on every machine.
compress::VisibilityScene visibility_scene(const Geometry& geometry);

} // namespace acdf::measure
