#include "input/triangles.h"

#include "input/image.h"
#include "input/mesh_file.h"

#include <assimp/Importer.hpp>
#include <assimp/scene.h>

#include <algorithm>
#include <cctype>
#include <cmath>

namespace acdf::input {
namespace {

/// As docs/conventions.md turns frames with y up; all zero where a coordinate is not finite.
bool turned(const aiVector3D& v, UpAxis up, std::array<float, 3>& out) {
    if (!std::isfinite(v.x) || !std::isfinite(v.y) || !std::isfinite(v.z)) return false;
    out = up == UpAxis::y ? std::array<float, 3>{v.z, v.x, v.y} : std::array<float, 3>{v.x, v.y, v.z};
    return true;
}

bool is_ply(const std::string& path) {
    std::string end = path.size() > 4 ? path.substr(path.size() - 4) : std::string();
    for (char& c : end) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    if (end != ".ply" && end != ".obj") throw input_error(path, "is no mesh: .obj or .ply");
    return end == ".ply";
}

bool corner_of(const aiMesh& mesh, unsigned index, UpAxis up, Triangles::Corner& out) {
    if (index >= mesh.mNumVertices || !turned(mesh.mVertices[index], up, out.position)) return false;
    if (!mesh.mNormals || !turned(mesh.mNormals[index], up, out.normal)) return true;
    double square = 0.0;
    for (const float x : out.normal) square += double{x} * double{x};
    const double scale = square > 0.0 && square < 1e30 ? 1.0 / std::sqrt(square) : 0.0;
    for (float& x : out.normal) x = static_cast<float>(double{x} * scale);
    return true;
}

} // namespace

Triangles read_triangles(const std::string& path, UpAxis up) {
    Assimp::Importer importer;
    const aiScene* scene = read_mesh(importer, path, is_ply(path));
    Triangles out;
    for (unsigned m = 0; m < scene->mNumMeshes; ++m) {
        const aiMesh& mesh = *scene->mMeshes[m];
        for (unsigned f = 0; f < mesh.mNumFaces; ++f) {
            const aiFace& face = mesh.mFaces[f];
            for (unsigned i = 1; i + 1 < face.mNumIndices; ++i) {
                Triangles::Corner corner[3];
                const bool right = corner_of(mesh, face.mIndices[0], up, corner[0]) &&
                                   corner_of(mesh, face.mIndices[i], up, corner[1]) &&
                                   corner_of(mesh, face.mIndices[i + 1], up, corner[2]);
                if (right) out.corners.insert(out.corners.end(), corner, corner + 3);
            }
        }
    }
    if (out.corners.empty()) throw input_error(path, "no triangle is in it");
    return out;
}

} // namespace acdf::input
