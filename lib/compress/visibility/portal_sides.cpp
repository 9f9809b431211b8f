#include "compress/visibility/portal_sides.h"

#include "compress/boxes.h"
#include "compress/local/light.h"
#include "compress/parallel.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <stdexcept>
#include <string>
#include <utility>

namespace acdf::compress {
namespace {

constexpr std::uint64_t kBatch = 1 << 12, kMostPoints = 1 << 18; // a closet sees little of a window
constexpr std::size_t kEnough = 64;                              // rays that decide
constexpr std::size_t kClearly = 4; // times as many must leave on one side as on the other
constexpr double kLeastCosine = 1e-3;

/// Rays that leave: to where across x up points, and the other way.
struct Leaving {
    std::size_t front = 0, back = 0;
};

Direction outside_of(const PortalRectangle& r) {
    const Direction &a = r.across, &b = r.up;
    const Direction out{a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
    const double length = std::sqrt(dot(out, out));
    return {out[0] / length, out[1] / length, out[2] / length};
}

/// 1: the ray from point `index` to some point of the portal goes on and leaves in front; -1: at the back; 0: it
/// does not leave.
int side_of_ray(const PortalRectangle& portal, const Direction& outside, const VisibilityScene& scene,
                std::uint64_t index) {
    VisibilityPoint point;
    if (!scene.points(index, point) || !is_near(point.position)) return 0;
    const double count = static_cast<double>(index) + 0.5, u = std::fmod(0.7548776662466927 * count, 1.0),
                 v = std::fmod(0.5698402909980532 * count, 1.0);
    Direction ray{};
    double height = 0.0;
    for (std::size_t k = 0; k < 3; ++k) {
        ray[k] = portal.corner[k] + u * portal.across[k] + v * portal.up[k] - double{point.position[k]};
        height += ray[k] * double{point.normal[k]};
    }
    const double length = std::sqrt(dot(ray, ray)), cosine = dot(ray, outside) / length;
    if (!(height > 0.0) || !(std::abs(cosine) > kLeastCosine)) return 0;
    std::array<float, 3> direction{};
    for (std::size_t k = 0; k < 3; ++k) direction[k] = static_cast<float>(ray[k] / length);
    return scene.occluded(point, direction) ? 0 : cosine > 0.0 ? 1 : -1;
}

Leaving count_leaving(const PortalRectangle& portal, const VisibilityScene& scene) {
    const Direction outside = outside_of(portal);
    Leaving out;
    std::vector<signed char> sides(kBatch);
    for (std::uint64_t first = 0; first < kMostPoints && out.front + out.back < kEnough; first += kBatch) {
        parallel_for(std::uint64_t{0}, kBatch, [&](std::uint64_t i) {
            sides[i] = static_cast<signed char>(side_of_ray(portal, outside, scene, first + i));
        });
        out.front += static_cast<std::size_t>(std::count(sides.begin(), sides.end(), 1));
        out.back += static_cast<std::size_t>(std::count(sides.begin(), sides.end(), -1));
    }
    return out;
}

/// Whether any of the light may shine on a plane from where it faces.
bool is_lit(const Target& target, const Direction& outside) {
    for (std::uint32_t r = 0; r < target.rows; ++r)
        for (std::uint32_t c = 0; c < target.columns; ++c) {
            if (!(target.row(r)[c] > 0.0f)) continue;
            const Box texel{{r, c}, {r + 1, c + 1}};
            if (dot(centre(target, texel), outside) > -radius(target, texel)) return true;
        }
    return false;
}

} // namespace

std::vector<PortalRectangle> facing_light(const Target& target, std::vector<PortalRectangle> rectangles,
                                          const VisibilityScene& scene) {
    for (std::size_t i = 0; i < rectangles.size(); ++i) {
        check_rectangle(rectangles[i], i);
        const Leaving leaving = count_leaving(rectangles[i], scene);
        const std::string name = "portal " + std::to_string(i + 1);
        if (leaving.front + leaving.back == 0)
            throw std::invalid_argument("no light arrives through " + name +
                                        ": it is closed, or not where the scene is");
        if (leaving.back > kClearly * leaving.front) std::swap(rectangles[i].across, rectangles[i].up);
        if (!is_lit(target, outside_of(rectangles[i])))
            throw std::invalid_argument(name + " gets no light from outside");
    }
    return rectangles;
}

} // namespace acdf::compress
