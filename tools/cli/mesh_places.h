// Places on the surfaces of a mesh, for files that tell places apart.
#pragma once

#include "input/mesh_surface.h"
#include "input/scene_normals.h"

#include <acdf/builder.h>

#include <memory>

namespace acdf::tools {

/// Points on both sides of a mesh, told by their number, and what the mesh hides from them. `up`: how it was turned
/// when it was read; positions are those of its file.
builder::Places places_on(std::shared_ptr<const input::MeshSurface> surface, input::UpAxis up);

} // namespace acdf::tools
