#include "compress/fit/octahedral_boxes.h"

#include <acdf/octahedral.h>

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

} // namespace

std::array<double, 3> octahedral_direction(const Target& target, double column, double row) {
    std::array<double, 3> d{};
    acdf_octahedral_direction(column / target.columns, row / target.rows, d.data());
    return d;
}

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

} // namespace acdf::compress
