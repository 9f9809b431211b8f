// Scenes as simple as set-ups of publications are, of analytic shapes and meshes: what samplers are compared on.
#pragma once

#include "input/mesh/surface.h"

#include <array>
#include <cmath>
#include <cstdint>
#include <memory>
#include <optional>
#include <variant>
#include <vector>

namespace acdf::measure {

using Vec3 = std::array<double, 3>;

inline Vec3 operator+(const Vec3& a, const Vec3& b) { return {a[0] + b[0], a[1] + b[1], a[2] + b[2]}; }
inline Vec3 operator-(const Vec3& a, const Vec3& b) { return {a[0] - b[0], a[1] - b[1], a[2] - b[2]}; }
inline Vec3 operator*(double s, const Vec3& a) { return {s * a[0], s * a[1], s * a[2]}; }
inline double dot(const Vec3& a, const Vec3& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }
inline Vec3 cross(const Vec3& a, const Vec3& b) {
    return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}
inline Vec3 normalized(const Vec3& a) { return (1.0 / std::sqrt(dot(a, a))) * a; }

struct Sphere {
    Vec3 centre{};
    double radius = 1.0;
};
/// Horizontal, at a height, as far as `extent` from the z axis.
struct Plane {
    double z = 0.0;
    double extent = 1e6;
};
/// With sides along the axes; low < high in each.
struct Box3 {
    Vec3 low{}, high{};
};
/// Triangles, both sides of them.
struct Mesh {
    std::shared_ptr<const input::MeshSurface> surface; ///< null until its file is read: then it is nowhere
};
using Shape = std::variant<Sphere, Plane, Box3, Mesh>;

struct Object {
    Shape shape;
    std::uint32_t material = 0;
    bool seen = true; ///< by the camera; what is not seen still hides light
};

struct Ray {
    Vec3 origin{}, direction{}; ///< direction is unit
};

struct Hit {
    double distance = 0.0; ///< along the ray, > 0
    Vec3 position{};
    Vec3 n{}; ///< unit, towards where the ray came from
    std::uint32_t object = 0;
};

/// The first point of a shape beyond `least` on the ray (its object is 0); none where it is missed.
std::optional<Hit> intersect(const Shape& shape, const Ray& ray, double least);

struct Camera {
    Vec3 from{4.0, 0.0, 0.0}, to{};
    double fov = 35.0; ///< degrees, of the height
    Vec3 up{0.0, 0.0, 1.0};

    /// Through the centre of a pixel; y grows downwards.
    Ray ray(std::uint32_t x, std::uint32_t y, std::uint32_t width, std::uint32_t height) const;
};

/// A rectangle that light comes through, for samplers of portals alone: it has no surface.
struct Portal {
    Vec3 corner{}, across{1.0, 0.0, 0.0}, up{0.0, 1.0, 0.0}; ///< two sides at right angles; light comes from the
                                                             ///< side that across x up points to
};

/// Objects do not light each other: light comes from outside, and reaches what no object hides.
struct Geometry {
    std::vector<Object> objects;
    /// Its meshes were turned from y up: files are asked for positions in their coordinates, (y, z, x) of these.
    bool turned = false;
    std::vector<Portal> portals{};

    /// What the camera sees along a ray.
    std::optional<Hit> trace(const Ray& ray) const;
    /// Whether any object, seen or not, lies on the ray, which begins at a surface with normal n.
    bool hidden(const Vec3& position, const Vec3& n, const Vec3& direction) const;
};

} // namespace acdf::measure
