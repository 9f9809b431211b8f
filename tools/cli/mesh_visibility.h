// Visibility on the surfaces of a mesh, for files that store visibility cells.
#pragma once

#include "input/mesh/surface.h"
#include "input/normals/scene.h"
#include "tools/cli/scene_option.h"

#include <acdf/builder.h>

#include <algorithm>
#include <memory>
#include <vector>

namespace acdf::tools {

/// Positions are given with y up, as meshes are turned.
inline void turn_from_y_up(builder::Visibility& visibility) {
    constexpr float turned[3][4] = {{0, 0, 1, 0}, {1, 0, 0, 0}, {0, 1, 0, 0}};
    for (int k = 0; k < 3; ++k) std::copy_n(turned[k], 4, visibility.transform[k]);
}

/// The normals of a mesh and their opposites: it may be wound either way, and rooms are seen from inside.
std::vector<builder::SceneNormal> both_sides(std::vector<builder::SceneNormal> normals);

/// All meshes of a scene as one; how many triangles each has is noted. Throws input::Error.
std::shared_ptr<const input::MeshSurface> read_surface(const SceneOption& scene, const Note& note);

/// Points on both sides of a mesh, by their number, and what the mesh hides from them; `volume`: half of them
/// in the air instead, all over its box, with normals all over the sphere. `up`: how it was turned when it was
/// read; positions are those of its file.
builder::Visibility visibility_on(std::shared_ptr<const input::MeshSurface> surface, input::UpAxis up,
                                  bool volume = false);

} // namespace acdf::tools
