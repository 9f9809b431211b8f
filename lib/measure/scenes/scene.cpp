#include "measure/scenes/scene.h"

#include <acdf/sample.h>

#include <algorithm>
#include <limits>

namespace acdf::measure {
namespace {

/// How far a shadow ray begins above its surface, in units of the scene, which are those of its objects.
constexpr double kLift = 1e-6;

std::optional<Hit> hit_at(const Ray& ray, double distance, const Vec3& outward) {
    return Hit{distance, ray.origin + distance * ray.direction,
               dot(outward, ray.direction) > 0.0 ? -1.0 * outward : outward, 0};
}

std::optional<Hit> meet(const Sphere& sphere, const Ray& ray, double least) {
    const Vec3 to_centre = sphere.centre - ray.origin;
    const double middle = dot(to_centre, ray.direction);
    const Vec3 across = to_centre - middle * ray.direction; // more digits than |c|^2 - middle^2 for far spheres
    const double half_square = sphere.radius * sphere.radius - dot(across, across);
    if (!(half_square >= 0.0)) return std::nullopt;
    const double half = std::sqrt(half_square);
    const double distance = middle - half > least ? middle - half : middle + half;
    if (!(distance > least)) return std::nullopt;
    const Vec3 position = ray.origin + distance * ray.direction;
    return hit_at(ray, distance, normalized(position - sphere.centre));
}

std::optional<Hit> meet(const Plane& plane, const Ray& ray, double least) {
    const double distance = (plane.z - ray.origin[2]) / ray.direction[2];
    if (!(distance > least) || !std::isfinite(distance)) return std::nullopt;
    const Vec3 position = ray.origin + distance * ray.direction;
    if (position[0] * position[0] + position[1] * position[1] > plane.extent * plane.extent) return std::nullopt;
    return hit_at(ray, distance, {0.0, 0.0, 1.0});
}

std::optional<Hit> meet(const Box3& box, const Ray& ray, double least) {
    // Slabs: the ray is inside from `enter` to `leave`.
    double enter = -std::numeric_limits<double>::infinity(), leave = std::numeric_limits<double>::infinity();
    std::size_t enter_axis = 0, leave_axis = 0;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const double d = ray.direction[axis];
        if (d == 0.0) { // parallel: 0 / 0 on a side would be no number
            if (ray.origin[axis] < box.low[axis] || ray.origin[axis] > box.high[axis]) return std::nullopt;
            continue;
        }
        double t0 = (box.low[axis] - ray.origin[axis]) / d, t1 = (box.high[axis] - ray.origin[axis]) / d;
        if (t0 > t1) std::swap(t0, t1);
        if (t0 > enter) enter = t0, enter_axis = axis;
        if (t1 < leave) leave = t1, leave_axis = axis;
    }
    if (!(enter <= leave)) return std::nullopt;
    const bool outside = enter > least;
    const double distance = outside ? enter : leave;
    if (!(distance > least)) return std::nullopt;
    Vec3 n{};
    n[outside ? enter_axis : leave_axis] = 1.0; // hit_at turns it towards the ray
    return hit_at(ray, distance, n);
}

std::optional<Hit> meet(const Mesh& mesh, const Ray& ray, double least) {
    if (!mesh.surface) return std::nullopt;
    const auto hit = mesh.surface->tree().first(ray.origin, ray.direction, least);
    if (!hit) return std::nullopt;
    return hit_at(ray, hit->distance, mesh.surface->triangles().face_normal(hit->triangle));
}

bool is_met(const Shape& shape, const Ray& ray) {
    const auto* mesh = std::get_if<Mesh>(&shape);
    if (!mesh) return intersect(shape, ray, 0.0).has_value();
    return mesh->surface && mesh->surface->tree().any(ray.origin, ray.direction, 0.0);
}

} // namespace

std::optional<Hit> intersect(const Shape& shape, const Ray& ray, double least) {
    return std::visit([&](const auto& s) { return meet(s, ray, least); }, shape);
}

Ray Camera::ray(std::uint32_t x, std::uint32_t y, std::uint32_t width, std::uint32_t height) const {
    const Vec3 forward = normalized(to - from), right = normalized(cross(forward, up)),
               above = cross(right, forward);
    const double half = std::tan(fov * (ACDF_PI / 360.0)), pixel = 2.0 * half / height;
    const double a = (x + 0.5 - 0.5 * width) * pixel, b = half - (y + 0.5) * pixel;
    return {from, normalized(forward + a * right + b * above)};
}

std::optional<Hit> Geometry::trace(const Ray& ray) const {
    std::optional<Hit> first;
    for (std::uint32_t i = 0; i < objects.size(); ++i) {
        if (!objects[i].seen) continue;
        std::optional<Hit> hit = intersect(objects[i].shape, ray, 0.0);
        if (!hit || (first && first->distance <= hit->distance)) continue;
        hit->object = i;
        first = hit;
    }
    return first;
}

bool Geometry::hidden(const Vec3& position, const Vec3& n, const Vec3& direction) const {
    const Ray ray{position + kLift * n, direction};
    return std::any_of(objects.begin(), objects.end(),
                       [&](const Object& object) { return is_met(object.shape, ray); });
}

} // namespace acdf::measure
