// Whether portals fit the openings of a mesh.
#pragma once

#include "input/mesh/surface.h"
#include "tools/cli/probe_source.h"

#include <acdf/builder.h>

namespace acdf::tools {

/// Notes each portal of `visibility` that lies outside of the scene, or is larger than the opening that it stands
/// for: neither is an error, as walls and rays decide what arrives, but samples through walls are lost.
void note_portals(const builder::Visibility& visibility, const input::MeshSurface& surface, const Note& note);

} // namespace acdf::tools
