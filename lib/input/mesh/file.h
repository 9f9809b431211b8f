// Meshes through the Open Asset Import Library, and where they stand in a scene.
#pragma once

#include "input/mesh/placement.h"

#include <functional>
#include <string>

struct aiMesh;

namespace acdf::input {

/// Whether a file is a mesh (.obj, .ply) or a list of instances of meshes (.instances), by its name.
bool is_mesh(const std::string& path);

/// Calls `take` with each mesh of a file and where it stands: as it is, or for a list of instances (instances.h)
/// once an instance; each file is read once, and nothing that it names. Throws Error.
void for_each_mesh(const std::string& path, const std::function<void(const aiMesh&, const Placement&)>& take);

} // namespace acdf::input
