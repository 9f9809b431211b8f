#include "input/mesh/file.h"
#include "input/normals/sources.h"

#include <assimp/mesh.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace acdf::input {
namespace {

struct Vector {
    double x = 0.0, y = 0.0, z = 0.0;
};

/// Half the cross product of two edges: the area, along the normal.
Vector area_of(const aiVector3D& a, const aiVector3D& b, const aiVector3D& c) {
    const Vector u{double{b.x} - a.x, double{b.y} - a.y, double{b.z} - a.z};
    const Vector v{double{c.x} - a.x, double{c.y} - a.y, double{c.z} - a.z};
    return {0.5 * (u.y * v.z - u.z * v.y), 0.5 * (u.z * v.x - u.x * v.z), 0.5 * (u.x * v.y - u.y * v.x)};
}

double length_of(const Vector& v) { return std::sqrt(v.x * v.x + v.y * v.y + v.z * v.z); }

bool has_direction(const aiVector3D& n) {
    const float square = n.x * n.x + n.y * n.y + n.z * n.z;
    return std::isfinite(square) && square > 0.0f;
}

/// Interpolated normals at the seven points of a quadrature of degree 3 (Stroud 1971, T2:3-1 with corners), with
/// the triangle's area as weight.
void add_smooth_triangle(const aiVector3D normal[3], double area, NormalHistogram& histogram) {
    const auto add = [&](double a, double b, double c, double share) {
        histogram.add(a * normal[0].x + b * normal[1].x + c * normal[2].x,
                      a * normal[0].y + b * normal[1].y + c * normal[2].y,
                      a * normal[0].z + b * normal[1].z + c * normal[2].z, area * share);
    };
    constexpr double third = 1.0 / 3.0;
    add(third, third, third, 9.0 / 20.0);
    for (const auto& edge : {std::array{0.5, 0.5, 0.0}, std::array{0.0, 0.5, 0.5}, std::array{0.5, 0.0, 0.5}})
        add(edge[0], edge[1], edge[2], 2.0 / 15.0);
    add(1.0, 0.0, 0.0, 1.0 / 20.0);
    add(0.0, 1.0, 0.0, 1.0 / 20.0);
    add(0.0, 0.0, 1.0, 1.0 / 20.0);
}

/// A mesh where it stands.
class Placed {
public:
    Placed(const aiMesh& mesh, const Placement& placement)
        : mesh_(mesh), placement_(placement), side_(placement.determinant() < 0.0 ? -1.0 : 1.0) {}

    bool has_normals() const { return mesh_.mNormals != nullptr; }
    /// -1 where it is mirrored: triangles are wound the other way round.
    double side() const { return side_; }
    aiVector3D vertex(unsigned i) const { return of(placement_.position(of(mesh_.mVertices[i]))); }
    aiVector3D normal(unsigned i) const { return of(placement_.normal(of(mesh_.mNormals[i]))); }
    bool has_corners(const aiFace& face) const {
        return std::all_of(face.mIndices, face.mIndices + face.mNumIndices,
                           [&](unsigned corner) { return corner < mesh_.mNumVertices; });
    }

private:
    static std::array<float, 3> of(const aiVector3D& v) { return {v.x, v.y, v.z}; }
    static aiVector3D of(const std::array<float, 3>& v) { return {v[0], v[1], v[2]}; }

    const aiMesh& mesh_;
    const Placement& placement_;
    double side_;
};

/// A polygon of three corners or more as a fan of triangles. The sum of their areas, as vectors, is exact for a
/// flat polygon of any shape (Newell's method); smooth polygons are taken to be convex.
void add_polygon(const Placed& mesh, const aiFace& face, NormalHistogram& histogram) {
    if (!mesh.has_corners(face)) return histogram.skip();
    const unsigned* corner = face.mIndices;
    bool smooth = mesh.has_normals();
    for (unsigned i = 0; smooth && i < face.mNumIndices; ++i) smooth = has_direction(mesh.normal(corner[i]));
    Vector sum;
    for (unsigned i = 1; i + 1 < face.mNumIndices; ++i) {
        const Vector area = area_of(mesh.vertex(corner[0]), mesh.vertex(corner[i]), mesh.vertex(corner[i + 1]));
        sum = {sum.x + area.x, sum.y + area.y, sum.z + area.z};
        const double size = length_of(area);
        if (!smooth || !(size > 0.0 && std::isfinite(size))) continue;
        aiVector3D normal[3] = {mesh.normal(corner[0]), mesh.normal(corner[i]), mesh.normal(corner[i + 1])};
        for (aiVector3D& n : normal) n.NormalizeSafe();
        add_smooth_triangle(normal, size, histogram);
    }
    const double size = length_of(sum);
    if (!(size > 0.0 && std::isfinite(size))) return histogram.skip();
    const double side = mesh.side();
    if (!smooth) histogram.add(side * sum.x, side * sum.y, side * sum.z, size);
}

} // namespace

void add_mesh_normals(const std::string& path, NormalHistogram& histogram) {
    for_each_mesh(path, [&](const aiMesh& mesh, const Placement& placement) {
        const Placed placed(mesh, placement);
        for (unsigned f = 0; f < mesh.mNumFaces; ++f) // lines and points have no normal
            if (mesh.mFaces[f].mNumIndices >= 3) add_polygon(placed, mesh.mFaces[f], histogram);
    });
}

} // namespace acdf::input
