// Where light is hidden: points of the demo scene.
#pragma once

#include "compress/target.h"
#include "measure/scenes/scene.h"
#include "tools/sweep/surface.h"

#include <cstdint>
#include <vector>

namespace acdf::tools {

/// A sphere on a plane beside a wall that the camera does not see: tools/render/scenes/demo-hidden.json.
measure::Geometry demo_geometry();
measure::Camera demo_camera();

/// About `count` points that the camera sees, evenly over the picture, and the texels of the target's map whose
/// middle is hidden from each. Uses all cores.
std::vector<SurfacePoint> behind_occluders(const compress::Target& target, std::uint32_t count);

} // namespace acdf::tools
