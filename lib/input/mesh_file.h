// Meshes through the Open Asset Import Library, one file and nothing that it names.
#pragma once

#include <string>

struct aiScene;
namespace Assimp {
class Importer;
}

namespace acdf::input {

/// Reads a mesh, OBJ or (`ply`) PLY, as it is. The result lives as long as the importer. Throws Error.
const aiScene* read_mesh(Assimp::Importer& importer, const std::string& path, bool ply);

} // namespace acdf::input
