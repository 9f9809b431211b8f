// Which source texels a cell of the sphere overlaps, and by how much.
#pragma once

#include "build/projection.h"
#include "compress/trigonometry.h"

#include <algorithm>
#include <cmath>

namespace acdf::build {

/// A cell of the lat-long grid, in half turns: phi falls from phi0 to phi1, theta grows from theta0 to theta1.
struct SphereCell {
    double phi0, phi1, theta0, theta1;
    double solid_angle() const {
        const double middle = compress::sine_cosine(0.5 * (theta0 + theta1)).sine;
        return compress::pi * (phi0 - phi1) * 2.0 * middle * compress::sine_cosine(0.5 * (theta1 - theta0)).sine;
    }
};

/// A polygon in texel coordinates, convex but for rounding. A convex quadrilateral cut along two rows and two
/// columns has at most eight corners; there is room for what the cuts make of any quadrilateral.
struct Polygon {
    double x[28], y[28];
    int size = 0;
};

/// The parts of `polygon` on both sides of x (axis 0) or y (axis 1) = border.
void split(const Polygon& polygon, int axis, double border, Polygon& below, Polygon& above);
double area(const Polygon& polygon);

/// The image of `cell` under `map`, in texels; false where it is not (nearly) a convex quadrilateral: across
/// borders of charts, at the rim of a disc, or where it is larger than a few texels.
bool image_of(const Map& map, const SphereCell& cell, Polygon& quad);

/// Calls visit(index, part) for the parts of `polygon` in each row (axis 1) or column (axis 0) of texels.
template <typename Visit>
void for_each_strip(const Polygon& polygon, int axis, Visit&& visit) {
    const double* along = axis == 0 ? polygon.x : polygon.y;
    const auto [low, high] = std::minmax_element(along, along + polygon.size);
    int strip = static_cast<int>(*low);
    const int last = static_cast<int>(*high);
    Polygon part, rests[2];
    const Polygon* rest = &polygon;
    for (; strip < last; ++strip) {
        Polygon& next = rest == &rests[0] ? rests[1] : rests[0];
        split(*rest, axis, strip + 1, part, next);
        visit(strip, part);
        rest = &next;
    }
    visit(strip, *rest);
}

/// Calls visit(column, row, solid_angle) for the texels that `cell` overlaps. The solid angles add up to the
/// cell's. Cells are halved until they are small and simple; after `depth` halvings, the middle decides.
template <typename Visit>
void for_each_overlap(const Map& map, const SphereCell& cell, int depth, Visit&& visit) {
    constexpr double small = 1.0 / 100.0 / compress::pi; // half turns across which a map is linear enough
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
        const compress::SineCosine phi = compress::sine_cosine(middle_phi),
                                   theta = compress::sine_cosine(middle_theta);
        const ImagePoint p = to_image(map, {theta.sine * phi.cosine, theta.sine * phi.sine, theta.cosine});
        visit(static_cast<int>(p.u * map.width), static_cast<int>(p.v * map.height), omega);
        return;
    }
    for_each_strip(quad, 1, [&](int row, const Polygon& in_row) {
        for_each_strip(in_row, 0, [&](int column, const Polygon& part) {
            // Corners that split() made may lie a rounding error outside of the image.
            visit(std::min(column, map.width - 1), row, omega * (area(part) / total));
        });
    });
}

} // namespace acdf::build
