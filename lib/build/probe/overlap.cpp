#include "build/probe/overlap.h"

namespace acdf::build {
namespace {

void add(Polygon& polygon, double x, double y) {
    polygon.x[polygon.size] = x;
    polygon.y[polygon.size++] = y;
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

// Both halves of a step of I. Sutherland and G. Hodgman, "Reentrant Polygon Clipping", 1974.
void split(const Polygon& polygon, int axis, double border, Polygon& below, Polygon& above) {
    below.size = above.size = 0;
    const double* along = axis == 0 ? polygon.x : polygon.y;
    for (int i = 0; i < polygon.size; ++i) {
        const int j = i + 1 < polygon.size ? i + 1 : 0;
        const double from = along[i] - border, to = along[j] - border;
        add(from < 0.0 ? below : above, polygon.x[i], polygon.y[i]);
        if ((from < 0.0) == (to < 0.0)) continue;
        const double t = from / (from - to);
        const double x = polygon.x[i] + t * (polygon.x[j] - polygon.x[i]);
        const double y = polygon.y[i] + t * (polygon.y[j] - polygon.y[i]);
        add(below, x, y);
        add(above, x, y);
    }
}

double area(const Polygon& polygon) {
    double twice = 0.0;
    for (int i = 1; i + 1 < polygon.size; ++i)
        twice += (polygon.x[i] - polygon.x[0]) * (polygon.y[i + 1] - polygon.y[0]) -
                 (polygon.x[i + 1] - polygon.x[0]) * (polygon.y[i] - polygon.y[0]);
    return 0.5 * std::abs(twice);
}

bool image_of(const Map& map, const std::array<Direction, 4>& corners, Polygon& quad) {
    int chart = 0;
    for (std::size_t i = 0; i < 4; ++i) {
        const ImagePoint point = to_image(map, corners[i]);
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

} // namespace acdf::build
