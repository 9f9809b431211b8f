#include "input/mesh/triangles.h"

#include "compress/visibility/light.h"
#include "input/error.h"
#include "input/mesh/file.h"

#include <assimp/mesh.h>

#include <cmath>

namespace acdf::input {
namespace {

/// More would take some 20 GB with their hierarchy.
constexpr std::size_t most_triangles = std::size_t{1} << 26;

/// As docs/conventions.md turns frames with y up.
std::array<float, 3> turned(const std::array<float, 3>& v, UpAxis up) {
    return up == UpAxis::y ? std::array<float, 3>{v[2], v[0], v[1]} : v;
}

bool are_finite(const std::array<float, 3>& v) {
    return std::isfinite(v[0]) && std::isfinite(v[1]) && std::isfinite(v[2]);
}

bool corner_of(const aiMesh& mesh, const Placement& placement, unsigned index, UpAxis up, Triangles::Corner& out) {
    if (index >= mesh.mNumVertices) return false;
    const aiVector3D& p = mesh.mVertices[index];
    out.position = turned(placement.position({p.x, p.y, p.z}), up);
    if (!compress::is_near(out.position)) return false;
    if (!mesh.mNormals) return true;
    const aiVector3D& n = mesh.mNormals[index];
    if (!are_finite({n.x, n.y, n.z})) return true;
    out.normal = turned(placement.normal({n.x, n.y, n.z}), up);
    double square = 0.0;
    for (const float x : out.normal) square += double{x} * double{x};
    const double scale = square > 0.0 && square < 1e30 ? 1.0 / std::sqrt(square) : 0.0;
    for (float& x : out.normal) x = static_cast<float>(double{x} * scale);
    return true;
}

void add_triangles(const aiMesh& mesh, const Placement& placement, UpAxis up, Triangles& out) {
    const bool mirrored = placement.determinant() < 0.0; // what was outside stays outside
    for (unsigned f = 0; f < mesh.mNumFaces; ++f) {
        const aiFace& face = mesh.mFaces[f];
        for (unsigned i = 1; i + 1 < face.mNumIndices; ++i) {
            Triangles::Corner corner[3];
            const bool right = corner_of(mesh, placement, face.mIndices[0], up, corner[0]) &&
                               corner_of(mesh, placement, face.mIndices[i], up, corner[mirrored ? 2 : 1]) &&
                               corner_of(mesh, placement, face.mIndices[i + 1], up, corner[mirrored ? 1 : 2]);
            if (right) out.corners.insert(out.corners.end(), corner, corner + 3);
        }
    }
}

} // namespace

Triangles read_triangles(const std::string& path, UpAxis up) {
    if (!is_mesh(path))
        throw input_error(path, "is neither a mesh (.obj, .ply) nor a list of instances (.instances)");
    Triangles out;
    for_each_mesh(path, [&](const aiMesh& mesh, const Placement& placement) {
        add_triangles(mesh, placement, up, out);
        if (out.count() > most_triangles) throw input_error(path, "it has more than 2^26 triangles");
    });
    if (out.corners.empty()) throw input_error(path, "it has no triangle whose corners are numbers below 1e30");
    return out;
}

} // namespace acdf::input
