#include "compress/visibility/portal_maps.h"

#include "compress/local/light.h"
#include "compress/parallel.h"
#include "compress/sum.h"

#include <acdf/grid.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>

namespace acdf::compress {
namespace {

using Vector = std::array<double, 3>;

/// Pieces of a portal along each side: how closely cosines and what hides it are followed.
constexpr std::uint32_t kPieces = 4;
/// Cells of a map along each axis: finer ones gain little, and coarser ones lose much
/// (docs/notes/visibility.md).
constexpr std::uint32_t kFinest = 256, kCoarsest = 64;
/// Visibility along each axis of a cell where light is looked up, at least and at most: as fine as the probe is.
constexpr int kFewest = 4, kMost = 32;
/// What the cells of a map add up to, about, and the least of one, of the mean.
constexpr double kWhole = 0x1p31, kFloor = 1e-3;
constexpr double kParallel = 1.0 - 1e-9, kRight = 1e-4;

Vector cross(const Vector& a, const Vector& b) {
    return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}
Vector unit(const Vector& v) {
    const double length = std::sqrt(dot(v, v));
    return {v[0] / length, v[1] / length, v[2] / length};
}
Vector axis_of(const AcdfPortalMap& map, int axis) {
    return {double{map.axis[axis][0]}, double{map.axis[axis][1]}, double{map.axis[axis][2]}};
}

[[noreturn]] void refuse(std::size_t portal, const char* what) {
    throw std::invalid_argument("portal " + std::to_string(portal + 1) + " " + what);
}

AcdfPortalMap map_of(const PortalRectangle& r) {
    const Vector x = unit(r.across), z = unit(cross(x, r.up)), y = cross(z, x);
    AcdfPortalMap out = {};
    for (std::size_t k = 0; k < 3; ++k) {
        out.axis[0][k] = static_cast<float>(x[k]);
        out.axis[1][k] = static_cast<float>(y[k]);
        out.axis[2][k] = static_cast<float>(z[k]);
    }
    return out;
}

/// Whether a map has the sides of a rectangle that faces the same way.
bool serves(const AcdfPortalMap& map, const AcdfPortalMap& own) {
    // Floats make a unit vector longer or shorter than 1 by more than the cosine may differ from it.
    const auto cosine = [&](int axis) { return dot(unit(axis_of(map, axis)), unit(axis_of(own, axis))); };
    if (cosine(2) < kParallel) return false;
    const double turned = std::fabs(cosine(0));
    return turned > kParallel || turned < 1e-6;
}

/// The rectangle along the axes of its map.
AcdfPortal portal_of(const PortalRectangle& r, const AcdfPortalMap& map, std::uint32_t number) {
    AcdfPortal out = {};
    out.map = number;
    Vector corner{};
    for (int axis = 0; axis < 3; ++axis) {
        const Vector along = axis_of(map, axis);
        const double at = dot(r.corner, along), across = dot(r.across, along), up = dot(r.up, along);
        const double low = at + std::min(across, 0.0) + std::min(up, 0.0);
        if (axis < 2) out.sides[axis] = static_cast<float>(std::fabs(across) + std::fabs(up));
        for (std::size_t k = 0; k < 3; ++k) corner[k] += (axis < 2 ? low : at) * along[k];
    }
    for (std::size_t k = 0; k < 3; ++k) out.corner[k] = static_cast<float>(corner[k]);
    return out;
}

/// The light of a cell: the root of the mean square of what is looked up in it, times its solid angle.
double light_of(const Target& target, const AcdfPortalMap& map, std::uint32_t size, std::uint32_t column,
                std::uint32_t row, int lookups) {
    const AcdfGrid grid = {target.columns, target.rows, static_cast<std::uint32_t>(target.parameterization)};
    const Vector x = axis_of(map, 0), y = axis_of(map, 1), z = axis_of(map, 2);
    double squares = 0.0, whole = 0.0;
    for (int j = 0; j < lookups; ++j)
        for (int i = 0; i < lookups; ++i) {
            const double a = acdf_unbend(column + (i + 0.5) / lookups, size),
                         b = acdf_unbend(row + (j + 0.5) / lookups, size), square = 1.0 + a * a + b * b,
                         length = std::sqrt(square);
            float direction[3];
            for (std::size_t k = 0; k < 3; ++k)
                direction[k] = static_cast<float>((a * x[k] + b * y[k] + z[k]) / length);
            const double bent = (1.0 + std::fabs(a)) * (1.0 + std::fabs(b)) * 2.0 / (double(lookups) * size);
            const double solid_angle = bent * bent / (square * length);
            std::uint32_t texel[2];
            double ignored[2];
            whole += solid_angle;
            if (!acdf_grid_square(&grid, direction, texel, ignored)) continue;
            const double value = double{target.row(texel[1])[texel[0]]};
            squares += value * value * solid_angle;
        }
    return std::sqrt(squares * whole);
}

/// Writes the sums of a map; returns its unit, 0 where there is no light.
double fill(const Target& target, const AcdfPortalMap& map, std::uint32_t size, std::uint32_t* sums) {
    const int lookups = std::clamp(static_cast<int>(target.columns / size), kFewest, kMost);
    std::vector<double> light(std::size_t{size} * size);
    parallel_for(0u, size, [&](std::uint32_t row) {
        for (std::uint32_t column = 0; column < size; ++column)
            light[std::size_t{row} * size + column] = light_of(target, map, size, column, row, lookups);
    });
    Sum all;
    for (const double one : light) all.add(one);
    if (!(all.value() > 0.0)) return 0.0;
    const double scale = kWhole / all.value(), least = std::max(kFloor * kWhole / double(light.size()), 1.0);
    const std::size_t width = std::size_t{size} + 1;
    for (std::uint32_t row = 0; row < size; ++row) {
        std::uint32_t before = 0;
        for (std::uint32_t column = 0; column < size; ++column) {
            before += static_cast<std::uint32_t>(std::max(scale * light[std::size_t{row} * size + column], least));
            sums[(row + 1) * width + column + 1] = sums[row * width + column + 1] + before;
        }
    }
    return 1.0 / scale;
}

} // namespace

void check_rectangle(const PortalRectangle& r, std::size_t number) {
    for (std::size_t k = 0; k < 3; ++k)
        if (!std::isfinite(r.corner[k]) || !std::isfinite(r.across[k]) || !std::isfinite(r.up[k]))
            refuse(number, "is not finite");
    const double across = std::sqrt(dot(r.across, r.across)), up = std::sqrt(dot(r.up, r.up));
    if (!(std::isfinite(across) && std::isfinite(up) && across >= 1e-12 && up >= 1e-12))
        refuse(number, "has no area");
    if (!(std::fabs(dot(r.across, r.up)) <= kRight * across * up))
        refuse(number, "is not a rectangle: its sides are not at right angles");
}

PortalSet make_portals(const Target& target, const std::vector<PortalRectangle>& rectangles, std::uint64_t bytes) {
    if (rectangles.size() > ACDF_MAX_PORTALS)
        throw std::invalid_argument("there are more than " + std::to_string(ACDF_MAX_PORTALS) + " portals");
    PortalSet out;
    for (std::size_t i = 0; i < rectangles.size(); ++i) {
        check_rectangle(rectangles[i], i);
        const AcdfPortalMap own = map_of(rectangles[i]);
        const auto found = std::find_if(out.maps.begin(), out.maps.end(),
                                        [&](const AcdfPortalMap& map) { return serves(map, own); });
        const auto number = static_cast<std::uint32_t>(found - out.maps.begin());
        if (found == out.maps.end()) out.maps.push_back(own);
        out.portals.push_back(portal_of(rectangles[i], out.maps[number], number));
        for (const float side : out.portals.back().sides)
            if (!(side > 0.0f)) refuse(i, "has no area");
    }
    std::uint32_t size = kFinest;
    while (size > kCoarsest &&
           out.maps.size() * (std::uint64_t{size} + 1) * (size + 1) * sizeof(std::uint32_t) > bytes)
        size /= 2;
    const std::size_t corners = (std::size_t{size} + 1) * (size + 1);
    out.header = {static_cast<std::uint32_t>(out.portals.size()), static_cast<std::uint32_t>(out.maps.size()), size,
                  kPieces};
    out.sums.assign(out.maps.size() * corners, 0);
    for (std::size_t m = 0; m < out.maps.size(); ++m) {
        const double one = fill(target, out.maps[m], size, &out.sums[m * corners]) / target.total;
        for (std::size_t i = 0; i < out.portals.size(); ++i)
            if (out.portals[i].map == m && !(one > 0.0 && std::isfinite(one)))
                refuse(i, "gets no light from outside");
        out.maps[m].unit = static_cast<float>(std::clamp(one, 0x1p-120, 0x1p120));
    }
    return out;
}

} // namespace acdf::compress
