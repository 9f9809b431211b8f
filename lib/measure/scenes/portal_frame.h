// A portal as a point sees it.
#pragma once

#include "measure/samplers/light_sampler.h"
#include "measure/scenes/scene.h"

#include <stdexcept>

namespace acdf::measure {

/// The axes of a portal, unit: along its sides, and towards where light comes from.
struct PortalAxes {
    Vec3 x{}, y{}, z{};

    Vec3 to_local(const Vec3& v) const { return {dot(v, x), dot(v, y), dot(v, z)}; }
    Vec3 to_world(const Vec3& v) const { return v[0] * x + v[1] * y + v[2] * z; }
};
inline PortalAxes axes_of(const Portal& portal) {
    const Vec3 x = normalized(portal.across), y = normalized(portal.up);
    return {x, y, cross(x, y)};
}

/// The rectangle relative to a point, along the portal's axes: from (low[0], low[1]) to (high[0], high[1]) at a
/// distance, which is > 0 where the portal is seen from inside.
struct PortalView {
    double low[2] = {}, high[2] = {}, distance = 0.0;

    bool seen() const { return distance > 0.0; }
    /// Whether a direction, along the portal's axes, goes through it.
    bool holds(const Vec3& d) const {
        if (!(seen() && d[2] > 0.0)) return false;
        const double scale = distance / d[2];
        for (std::size_t k = 0; k < 2; ++k)
            if (!(scale * d[k] >= low[k] && scale * d[k] <= high[k])) return false;
        return true;
    }
};
inline PortalView view_of(const Portal& portal, const PortalAxes& axes, const Vec3& from) {
    const Vec3 corner = axes.to_local(portal.corner - from);
    return {{corner[0], corner[1]},
            {corner[0] + std::sqrt(dot(portal.across, portal.across)),
             corner[1] + std::sqrt(dot(portal.up, portal.up))},
            corner[2]};
}

/// Where a shading point is in the coordinates of portals.
inline Vec3 position_of(const ShadingPoint& point, bool turned) {
    const Vec3 p{double{point.position[0]}, double{point.position[1]}, double{point.position[2]}};
    return turned ? Vec3{p[2], p[0], p[1]} : p;
}

inline void check_portals(const std::vector<Portal>& portals) {
    if (portals.empty()) throw std::invalid_argument("the scene has no portals");
}

} // namespace acdf::measure
