#include "compress/boxes.h"

#include <acdf/octahedral.h>
#include <acdf/sample.h>

#include <algorithm>
#include <cmath>

namespace acdf::compress {
namespace {

constexpr int kPoints = 8; // on a side

bool holds(const Target& target, const Box& box, const std::array<double, 3>& n) {
    double u, v;
    acdf_octahedral_point(n.data(), &u, &v);
    u *= target.columns;
    v *= target.rows;
    return u >= box.begin[1] && u <= box.end[1] && v >= box.begin[0] && v <= box.end[0];
}

/// The angle, in radians, from n to the nearest of points along a side, less what lies between them.
double side_angle(const Target& target, const double (&from)[2], const double (&to)[2],
                  const std::array<double, 3>& n) {
    double largest = -1.0;
    for (int i = 0; i <= kPoints; ++i) {
        const double t = double(i) / kPoints;
        const std::array<double, 3> d =
            octahedral_direction(target, from[0] + t * (to[0] - from[0]), from[1] + t * (to[1] - from[1]));
        largest = std::max(largest, d[0] * n[0] + d[1] * n[1] + d[2] * n[2]);
    }
    largest = std::min(largest, 1.0);
    const double side = std::abs(to[0] - from[0]) / target.columns + std::abs(to[1] - from[1]) / target.rows;
    const double angle = ACDF_PI * acdf_atan2pi(std::sqrt((1.0 - largest) * (1.0 + largest)), largest);
    return angle - 0.5 * ACDF_OCTAHEDRAL_SPEED * side / kPoints;
}

/// A cosine that no direction of a box exceeds with the unit vector `n`, and that is near the largest: 1 inside,
/// else that at its border, from points an eighth of a side apart and what may lie between them.
double largest_octahedral_cosine(const Target& target, const Box& box, const std::array<double, 3>& n) {
    if (holds(target, box, n)) return 1.0;
    const double corner[4][2] = {{double(box.begin[1]), double(box.begin[0])},
                                 {double(box.end[1]), double(box.begin[0])},
                                 {double(box.end[1]), double(box.end[0])},
                                 {double(box.begin[1]), double(box.end[0])}};
    double nearest = ACDF_PI;
    for (int i = 0; i < 4; ++i) nearest = std::min(nearest, side_angle(target, corner[i], corner[(i + 1) % 4], n));
    double sine, cosine;
    acdf_sincospi(std::max(0.0, nearest) / ACDF_PI, &sine, &cosine);
    return cosine;
}

/// The largest cosine between a unit vector and any direction of a box; on the octahedral square a bound near it.
double largest_cosine(const Target& target, const Box& box, const std::array<double, 3>& n) {
    if (is_octahedral(target)) return largest_octahedral_cosine(target, box, n);
    const double sine = std::hypot(n[0], n[1]);
    double column = target.columns * (0.5 - 0.5 * acdf_atan2pi(n[1], n[0]));
    double best = 1.0; // cosine of the difference in azimuth
    if (column < box.begin[1] || column > box.end[1]) {
        best = -1.0;
        for (double end : {double(box.begin[1]), double(box.end[1])}) {
            double s, c;
            acdf_sincospi(2.0 * std::remainder(end - column, target.columns) / target.columns, &s, &c);
            best = std::max(best, c);
        }
    }
    const double a = sine * best; // cosine = a sin(theta) + n.z cos(theta), largest at atan2(a, n.z)
    const double row = target.rows * acdf_atan2pi(a, n[2]);
    if (row >= box.begin[0] && row <= box.end[0]) return std::hypot(a, n[2]);
    double largest = -1.0;
    for (std::uint32_t end : {box.begin[0], box.end[0]}) {
        double s, c;
        acdf_sincospi(double(end) / target.rows, &s, &c);
        largest = std::max(largest, a * s + n[2] * c);
    }
    return largest;
}

} // namespace

std::array<double, 3> octahedral_direction(const Target& target, double column, double row) {
    std::array<double, 3> d{};
    acdf_octahedral_direction(column / target.columns, row / target.rows, d.data());
    return d;
}

std::array<double, 3> centre(const Target& target, const Box& box) {
    if (is_octahedral(target))
        return octahedral_direction(target, 0.5 * (double(box.begin[1]) + box.end[1]),
                                    0.5 * (double(box.begin[0]) + box.end[0]));
    const double z = 0.5 * (acdf_row_z(box.begin[0], target.rows) + acdf_row_z(box.end[0], target.rows));
    const double r = std::sqrt(std::max(0.0, 1.0 - z * z));
    double s, c;
    acdf_sincospi(1.0 - (double(box.begin[1]) + double(box.end[1])) / target.columns, &s, &c);
    return {r * c, r * s, z};
}

double radius(const Target& target, const Box& box) {
    std::array<double, 3> opposite = centre(target, box);
    for (double& x : opposite) x = -x;
    return std::sqrt(std::max(0.0, 2.0 + 2.0 * largest_cosine(target, box, opposite)));
}

} // namespace acdf::compress
