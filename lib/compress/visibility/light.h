// How much of the light reaches points of a scene, found by rays.
#pragma once

#include "compress/visibility/parts.h"
#include "compress/visibility/portal_maps.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <functional>
#include <memory>
#include <vector>

namespace acdf::compress {

/// Farther out than 1e30 there is no scene: sizes and areas, and differences of floats, must be numbers.
inline bool is_near(const std::array<float, 3>& position) {
    return std::all_of(position.begin(), position.end(), [](float x) { return std::fabs(x) <= 1e30f; });
}

/// A point of a surface, or in the air, where light is gathered.
struct VisibilityPoint {
    std::array<float, 3> position{}, normal{}; ///< among the cells; in the frame of directions

    /// Axes of cells: those of the position, then those of the normal.
    float coordinate(std::size_t axis) const { return axis < 3 ? position[axis] : normal[axis - 3]; }
};

/// Point `index` of an endless sequence all over the surfaces of a scene; false where that number has none. Called
/// by several threads at once; the same for the same number.
using PointSource = std::function<bool(std::uint64_t index, VisibilityPoint& point)>;

/// Whether anything lies on the ray from a point towards a direction (in the frame of directions). Called by
/// several threads at once; the same for the same arguments.
using Occluded = std::function<bool(const VisibilityPoint& point, const std::array<float, 3>& direction)>;

/// What each part would give to each point, and whether its ray arrives. It is divided by what all parts give to
/// the point (and by a tenth of the mean of all points, so that the darkest do not decide alone): squares are then
/// what relative variance is made of.
struct VisibilityLight {
    std::size_t parts = 0;
    std::vector<float> given;    ///< points x parts; negative where the ray does not arrive
    std::vector<double> arrives; ///< one a point: the light that its rays find
    std::vector<double> scale;   ///< one a point: what its light is multiplied with
    double dark = 0.0;           ///< what is added to the light of each point

    const float* of(std::size_t point) const { return &given[point * parts]; }
    double all(std::size_t point, std::size_t part) const { return std::fabs(double{given[point * parts + part]}); }
    double seen(std::size_t point, std::size_t part) const {
        const float g = given[point * parts + part];
        return g > 0.0f ? double{g} : 0.0;
    }
    /// Divides what belongs to a point anew, where its light is better known than from its own rays.
    void rescale(std::size_t point, double light);

    std::size_t points() const { return scale.size(); }
};

/// What a scene is to the fit.
struct VisibilityScene {
    PointSource points;
    Occluded occluded;
    std::shared_ptr<const PortalSet> portals{}; ///< the portals that light comes through; null: not known

    explicit operator bool() const { return points && occluded; }
};

/// The rays of a point, one a part, as those near it let expect; null where nothing is.
using ExpectedRays = std::function<const Ray*(std::size_t point)>;

/// Shoots a ray for each point and part that is above its horizon, from the points on that `light` does not know
/// yet; where one is expected, and the part gives little, one in four is shot. `dark`: of other points of the
/// scene; below 0: as it is found of all these. The same for any number of threads.
void trace_visibility(const VisibilityParts& parts, const std::vector<VisibilityPoint>& points,
                      const Occluded& occluded, const ExpectedRays& expected, VisibilityLight& light,
                      double dark = -1.0, const std::function<void(double)>& progress = {});

} // namespace acdf::compress
