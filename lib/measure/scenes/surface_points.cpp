#include "measure/scenes/surface_points.h"

#include "measure/sequences.h"

#include <acdf/sample.h>

#include <algorithm>

namespace acdf::measure {
namespace {

double area(const Sphere& sphere) { return 4.0 * ACDF_PI * sphere.radius * sphere.radius; }
double area(const Plane& plane) { return ACDF_PI * plane.extent * plane.extent; }
double area(const Box3& box) {
    const Vec3 side = box.high - box.low;
    return 2.0 * (side[0] * side[1] + side[1] * side[2] + side[2] * side[0]);
}

/// How many of the points an object gets: the root of its area, of a mesh the sum of those of its triangles.
template <class S>
double weight(const S& shape) {
    return std::sqrt(area(shape));
}
double weight(const Mesh& mesh) { return mesh.surface ? mesh.surface->weight() : 0.0; }

struct SurfacePoint {
    Vec3 position{}, n{};
};

SurfacePoint at_shape(const Mesh& mesh, double u, double v, std::uint64_t index) {
    const input::MeshSurface::Point point = mesh.surface->at(u, v, input::is_front(index));
    return {point.position, point.normal};
}

SurfacePoint at_shape(const Sphere& sphere, double u, double v, std::uint64_t) {
    double sine, cosine;
    acdf_sincospi(2.0 * u - 1.0, &sine, &cosine);
    const double z = 1.0 - 2.0 * v, r = std::sqrt((1.0 - z) * (1.0 + z));
    const Vec3 n{r * cosine, r * sine, z};
    return {sphere.centre + sphere.radius * n, n};
}

SurfacePoint at_shape(const Plane& plane, double u, double v, std::uint64_t) {
    double sine, cosine;
    const bool below = u < 0.02; // its lower side is seldom seen
    acdf_sincospi(2.0 * (below ? u / 0.02 : (u - 0.02) / 0.98) - 1.0, &sine, &cosine);
    const double r = plane.extent * std::sqrt(v);
    return {{r * cosine, r * sine, plane.z}, {0.0, 0.0, below ? -1.0 : 1.0}};
}

SurfacePoint at_shape(const Box3& box, double u, double v, std::uint64_t) {
    const Vec3 side = box.high - box.low;
    const double whole = area(box);
    for (std::size_t axis = 0;; ++axis)
        for (int upper = 0; upper < 2; ++upper) {
            const std::size_t a = (axis + 1) % 3, b = (axis + 2) % 3;
            const double share = side[a] * side[b] / whole;
            if (u >= share && !(axis == 2 && upper == 1)) {
                u -= share;
                continue;
            }
            SurfacePoint out;
            out.position = box.low;
            if (upper) out.position[axis] = box.high[axis];
            out.position[a] += side[a] * std::min(u / share, 1.0);
            out.position[b] += side[b] * v;
            out.n[axis] = upper ? 1.0 : -1.0;
            return out;
        }
}

compress::VisibilityPoint place_point(const SurfacePoint& surface) {
    compress::VisibilityPoint out;
    for (std::size_t k = 0; k < 3; ++k) {
        out.position[k] = static_cast<float>(surface.position[k]);
        out.normal[k] = static_cast<float>(surface.n[k]);
    }
    return out;
}

Vec3 vector(const std::array<float, 3>& v) { return {double{v[0]}, double{v[1]}, double{v[2]}}; }

} // namespace

compress::VisibilityScene visibility_scene(const Geometry& geometry) {
    std::vector<double> upto; // shares of the objects, summed
    double sum = 0.0;
    for (const Object& object : geometry.objects)
        upto.push_back(sum +=
                       object.seen ? std::visit([](const auto& s) { return weight(s); }, object.shape) : 0.0);
    compress::VisibilityScene out;
    out.points = [&geometry, upto](std::uint64_t index, compress::VisibilityPoint& point) {
        const auto number = static_cast<std::uint32_t>(index + 1);
        const double at =
            std::fmod((number + 0.5) * 0.6180339887498949, 1.0) * upto.back(); // of Kronecker's sequence
        const auto object =
            static_cast<std::size_t>(std::upper_bound(upto.begin(), upto.end() - 1, at) - upto.begin());
        const std::array<std::uint32_t, 2> u = sobol_point(number);
        point = place_point(
            std::visit([&](const auto& s) { return at_shape(s, u[0] * 0x1p-32, u[1] * 0x1p-32, index); },
                       geometry.objects[object].shape));
        return geometry.objects[object].seen && upto.back() > 0.0;
    };
    out.occluded = [&geometry](const compress::VisibilityPoint& point, const std::array<float, 3>& direction) {
        Vec3 position = vector(point.position); // rounded: a little above where it may have come to lie
        const double size = std::max({std::fabs(position[0]), std::fabs(position[1]), std::fabs(position[2]), 1.0});
        position = position + 1e-6 * size * vector(point.normal);
        return geometry.hidden(position, vector(point.normal), vector(direction));
    };
    return out;
}

} // namespace acdf::measure
