// Which source texels a cell of the sphere overlaps, and by how much.
#pragma once

#include "input/projection.h"

#include <algorithm>
#include <cmath>

namespace acdf::input {

/// A cell of the lat-long grid: phi falls from phi0 to phi1, theta grows from theta0 to theta1.
struct SphereCell {
    double phi0, phi1, theta0, theta1;
    double solid_angle() const {
        return (phi0 - phi1) * 2.0 * std::sin(0.5 * (theta0 + theta1)) * std::sin(0.5 * (theta1 - theta0));
    }
};

/// A convex polygon in texel coordinates. A quadrilateral clipped by four lines has at most eight corners; but
/// for rounding, so there is room for what four clips make of any quadrilateral (each at most half as many again).
struct Polygon {
    double x[20], y[20];
    int size = 0;
};

/// The part of `polygon` between low and high in x (axis 0) or y (axis 1).
void clip(const Polygon& polygon, int axis, double low, double high, Polygon& clipped);
double area(const Polygon& polygon);

/// The image of `cell` under `map`, in texels; false where it is not (nearly) a convex quadrilateral: across
/// borders of charts, at the rim of a disc, or where it is larger than a few texels.
bool image_of(const Map& map, const SphereCell& cell, Polygon& quad);

/// Calls visit(column, row, solid_angle) for the texels that `cell` overlaps. The solid angles add up to the
/// cell's. Cells are halved until they are small and simple; after `depth` halvings, the middle decides.
template <typename Visit>
void for_each_overlap(const Map& map, const SphereCell& cell, int depth, Visit&& visit) {
    constexpr double small = 1.0 / 100.0; // radians across which a map is linear enough
    const double middle_phi = 0.5 * (cell.phi0 + cell.phi1), middle_theta = 0.5 * (cell.theta0 + cell.theta1);
    Polygon quad;
    const bool simple = cell.theta1 - cell.theta0 <= small && image_of(map, cell, quad);
    if (!simple && depth > 0) {
        for_each_overlap(map, {cell.phi0, middle_phi, cell.theta0, middle_theta}, depth - 1, visit);
        for_each_overlap(map, {middle_phi, cell.phi1, cell.theta0, middle_theta}, depth - 1, visit);
        for_each_overlap(map, {cell.phi0, middle_phi, middle_theta, cell.theta1}, depth - 1, visit);
        for_each_overlap(map, {middle_phi, cell.phi1, middle_theta, cell.theta1}, depth - 1, visit);
        return;
    }
    const double omega = cell.solid_angle(), total = simple ? area(quad) : 0.0;
    if (!(total > 1e-12)) {
        const ImagePoint p = to_image(map, {std::sin(middle_theta) * std::cos(middle_phi),
                                            std::sin(middle_theta) * std::sin(middle_phi), std::cos(middle_theta)});
        visit(static_cast<int>(p.u * map.width), static_cast<int>(p.v * map.height), omega);
        return;
    }
    const auto [x0, x1] = std::minmax({quad.x[0], quad.x[1], quad.x[2], quad.x[3]});
    const auto [y0, y1] = std::minmax({quad.y[0], quad.y[1], quad.y[2], quad.y[3]});
    const int c0 = static_cast<int>(x0), c1 = static_cast<int>(x1);
    const int r0 = static_cast<int>(y0), r1 = static_cast<int>(y1);
    if (c0 == c1 && r0 == r1) return visit(c0, r0, omega);
    for (int r = r0; r <= r1; ++r) {
        Polygon row, part;
        clip(quad, 1, r, r + 1, row);
        for (int c = c0; c <= c1; ++c) {
            clip(row, 0, c, c + 1, part);
            const double share = area(part);
            if (share > 0.0) visit(c, r, omega * (share / total));
        }
    }
}

} // namespace acdf::input
