// Which source texels a cell of the sphere overlaps, and by how much.
#pragma once

#include "build/probe/projection.h"
#include "compress/trigonometry.h"

#include <acdf/octahedral.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace acdf::build {

/// Corners of a cell lie so much of its sides inside, so that they belong to this cell's side of a border.
constexpr double hair = 1e-7;
/// A cell is small enough for a map to be linear in it if it is no taller than this, in radians.
constexpr double small_cell = 0.01;

/// A cell of the lat-long grid, in half turns: phi falls from phi0 to phi1, theta grows from theta0 to theta1.
struct SphereCell {
    double phi0, phi1, theta0, theta1;

    double solid_angle() const {
        const double middle = compress::sine_cosine(0.5 * (theta0 + theta1)).sine;
        return compress::pi * (phi0 - phi1) * 2.0 * middle * compress::sine_cosine(0.5 * (theta1 - theta0)).sine;
    }
    bool is_small() const { return theta1 - theta0 <= small_cell / compress::pi; }
    Direction middle() const {
        return direction(compress::sine_cosine(0.5 * (phi0 + phi1)),
                         compress::sine_cosine(0.5 * (theta0 + theta1)));
    }
    /// Around the cell.
    std::array<Direction, 4> corners() const {
        const double dphi = hair * (phi1 - phi0), dtheta = hair * (theta1 - theta0);
        const compress::SineCosine phi[2] = {compress::sine_cosine(phi0 + dphi),
                                             compress::sine_cosine(phi1 - dphi)};
        const compress::SineCosine theta[2] = {compress::sine_cosine(theta0 + dtheta),
                                               compress::sine_cosine(theta1 - dtheta)};
        return {direction(phi[0], theta[0]), direction(phi[1], theta[0]), direction(phi[1], theta[1]),
                direction(phi[0], theta[1])};
    }
    std::array<SphereCell, 4> quarters() const {
        const double phi = 0.5 * (phi0 + phi1), theta = 0.5 * (theta0 + theta1);
        return {SphereCell{phi0, phi, theta0, theta}, SphereCell{phi, phi1, theta0, theta},
                SphereCell{phi0, phi, theta, theta1}, SphereCell{phi, phi1, theta, theta1}};
    }

private:
    static Direction direction(const compress::SineCosine& phi, const compress::SineCosine& theta) {
        return {theta.sine * phi.cosine, theta.sine * phi.sine, theta.cosine};
    }
};

/// A cell of the octahedral square.
struct SquareCell {
    double u0, u1, v0, v1;

    double solid_angle() const { return 4.0 * compress::pi * (u1 - u0) * (v1 - v0); }
    bool is_small() const { return ACDF_OCTAHEDRAL_SPEED * (v1 - v0) <= small_cell; }
    Direction middle() const { return direction(0.5 * (u0 + u1), 0.5 * (v0 + v1)); }
    std::array<Direction, 4> corners() const {
        const double du = hair * (u1 - u0), dv = hair * (v1 - v0);
        return {direction(u0 + du, v0 + dv), direction(u1 - du, v0 + dv), direction(u1 - du, v1 - dv),
                direction(u0 + du, v1 - dv)};
    }
    std::array<SquareCell, 4> quarters() const {
        const double u = 0.5 * (u0 + u1), v = 0.5 * (v0 + v1);
        return {SquareCell{u0, u, v0, v}, SquareCell{u, u1, v0, v}, SquareCell{u0, u, v, v1},
                SquareCell{u, u1, v, v1}};
    }

private:
    static Direction direction(double u, double v) {
        double d[3];
        acdf_octahedral_direction(u, v, d);
        return {d[0], d[1], d[2]};
    }
};

/// What a texel of the grid, in column `of`, overlaps of a texel of the map, numbered by rows.
struct Overlap {
    std::uint32_t of, texel;
    double omega;
};
inline Overlap overlap(std::size_t of, std::size_t texel, double omega) {
    return {static_cast<std::uint32_t>(of), static_cast<std::uint32_t>(texel), omega};
}

/// The overlaps of a grid by its rows, from one pass over them to the next, where there are few texels: small maps
/// are cut into as many cells as larger ones. Some 20 MB at most.
class KeptOverlaps {
public:
    KeptOverlaps(const Map& map, std::size_t columns, std::size_t rows) {
        if (columns * rows <= 256 * 128 && double(map.width) * map.height < 0x1p32) rows_.resize(rows);
    }
    bool any() const { return !rows_.empty(); }
    void keep(std::size_t row, const std::vector<Overlap>& found) { rows_[row] = found; } // no larger than it is
    const std::vector<Overlap>& operator[](std::size_t row) const { return rows_[row]; }

private:
    std::vector<std::vector<Overlap>> rows_;
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

/// The image under `map` of the cell that has these corners, in texels; false where it is not (nearly) a convex
/// quadrilateral: across borders of charts, at the rim of a disc, or where it is larger than a few texels.
bool image_of(const Map& map, const std::array<Direction, 4>& corners, Polygon& quad);

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

/// Calls visit(column, row, solid_angle, polygon) for the texels that `cell` (one of the above) overlaps, or for
/// `parts` times `parts` parts of each, numbered over the whole map. The solid angles add up to the cell's. The
/// polygon is what is overlapped, in such parts, or one point of it: cells are halved until they are small and
/// simple; after `depth` halvings, the middle decides.
template <typename Cell, typename Visit>
void for_each_overlap(const Map& map, const Cell& cell, int depth, Visit&& visit, int parts = 1) {
    Polygon quad;
    const bool simple = cell.is_small() && image_of(map, cell.corners(), quad);
    if (!simple && depth > 0) {
        for (const Cell& quarter : cell.quarters()) for_each_overlap(map, quarter, depth - 1, visit, parts);
        return;
    }
    for (int i = 0; parts > 1 && i < quad.size; ++i) {
        quad.x[i] *= parts;
        quad.y[i] *= parts;
    }
    const int columns = map.width * parts, rows = map.height * parts;
    const double omega = cell.solid_angle(), total = simple ? area(quad) : 0.0;
    if (!(total > 1e-12)) {
        const ImagePoint p = to_image(map, cell.middle());
        quad.size = 1;
        quad.x[0] = p.u * columns;
        quad.y[0] = p.v * rows;
        visit(static_cast<int>(quad.x[0]), static_cast<int>(quad.y[0]), omega, quad);
        return;
    }
    for_each_strip(quad, 1, [&](int row, const Polygon& in_row) {
        for_each_strip(in_row, 0, [&](int column, const Polygon& part) {
            // Corners that split() made may lie a rounding error outside of the image.
            visit(std::min(column, columns - 1), row, omega * (area(part) / total), part);
        });
    });
}

} // namespace acdf::build
