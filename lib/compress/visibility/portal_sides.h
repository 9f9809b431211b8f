// Which side of a portal light comes from, whichever way it is wound.
#pragma once

#include "compress/target.h"
#include "compress/visibility/light.h"
#include "compress/visibility/portal_maps.h"

#include <vector>

namespace acdf::compress {

/// The rectangles, each turned where it has to be: light comes from the side that across x up points to. Rays from
/// points of the scene decide, which leave through a portal and meet nothing. Where many leave on either side, a
/// portal stays as it is wound. It takes a small part of a second. Throws std::invalid_argument where a rectangle
/// is none, no ray leaves through it, or no light of `target` shines on it from outside.
std::vector<PortalRectangle> facing_light(const Target& target, std::vector<PortalRectangle> rectangles,
                                          const VisibilityScene& scene);

} // namespace acdf::compress
