#include "input/overlap.h"

namespace acdf::input {
namespace {

// Keeps the side of `polygon` where sign * (coordinate - border) >= 0 (Sutherland and Hodgman 1974).
void clip_half(const Polygon& polygon, int axis, double border, double sign, Polygon& kept) {
    kept.size = 0;
    const double* along = axis == 0 ? polygon.x : polygon.y;
    for (int i = 0; i < polygon.size; ++i) {
        const int j = i + 1 < polygon.size ? i + 1 : 0;
        const double from = sign * (along[i] - border), to = sign * (along[j] - border);
        if (from >= 0.0) {
            kept.x[kept.size] = polygon.x[i];
            kept.y[kept.size++] = polygon.y[i];
        }
        if ((from < 0.0) != (to < 0.0)) {
            const double t = from / (from - to);
            kept.x[kept.size] = polygon.x[i] + t * (polygon.x[j] - polygon.x[i]);
            kept.y[kept.size++] = polygon.y[i] + t * (polygon.y[j] - polygon.y[i]);
        }
    }
}

bool convex(const Polygon& quad) {
    int left = 0, right = 0;
    for (int i = 0; i < 4; ++i) {
        const int j = (i + 1) % 4, k = (i + 2) % 4;
        const double turn =
            (quad.x[j] - quad.x[i]) * (quad.y[k] - quad.y[j]) - (quad.y[j] - quad.y[i]) * (quad.x[k] - quad.x[j]);
        left += turn > 0.0;
        right += turn < 0.0;
    }
    return left == 0 || right == 0;
}

} // namespace

void clip(const Polygon& polygon, int axis, double low, double high, Polygon& clipped) {
    Polygon above;
    clip_half(polygon, axis, low, 1.0, above);
    clip_half(above, axis, high, -1.0, clipped);
}

double area(const Polygon& polygon) {
    double twice = 0.0;
    for (int i = 1; i + 1 < polygon.size; ++i)
        twice += (polygon.x[i] - polygon.x[0]) * (polygon.y[i + 1] - polygon.y[0]) -
                 (polygon.x[i + 1] - polygon.x[0]) * (polygon.y[i] - polygon.y[0]);
    return 0.5 * std::abs(twice);
}

bool image_of(const Map& map, const SphereCell& cell, Polygon& quad) {
    // A hair inside, so that corners on a border belong to this cell's side of it.
    constexpr double hair = 1e-7;
    const double dphi = hair * (cell.phi1 - cell.phi0), dtheta = hair * (cell.theta1 - cell.theta0);
    const double phi[2] = {cell.phi0 + dphi, cell.phi1 - dphi};
    const double theta[2] = {cell.theta0 + dtheta, cell.theta1 - dtheta};
    const double cosine[2] = {std::cos(phi[0]), std::cos(phi[1])}, sine[2] = {std::sin(phi[0]), std::sin(phi[1])};
    int chart = 0;
    for (int i = 0; i < 4; ++i) {
        const int p = i == 1 || i == 2, t = i >= 2;
        const double sin_theta = std::sin(theta[t]);
        const ImagePoint point = to_image(map, {sin_theta * cosine[p], sin_theta * sine[p], std::cos(theta[t])});
        if (i == 0) chart = point.chart;
        if (point.chart != chart) return false;
        quad.x[i] = point.u * map.width;
        quad.y[i] = point.v * map.height;
    }
    quad.size = 4;
    if (!convex(quad)) return false; // twisted: near the rim of a disc
    const auto [x0, x1] = std::minmax({quad.x[0], quad.x[1], quad.x[2], quad.x[3]});
    const auto [y0, y1] = std::minmax({quad.y[0], quad.y[1], quad.y[2], quad.y[3]});
    // Around the rim of a disc the sides bend: by extent^2 / (8 radius), here a fiftieth of a texel.
    const double extent = std::max(2.0, std::sqrt(0.08 * map.width));
    return x1 - x0 <= extent && y1 - y0 <= extent;
}

} // namespace acdf::input
