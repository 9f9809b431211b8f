#include "input/mesh/surface.h"

#include <algorithm>
#include <cmath>

namespace acdf::input {

bool is_front(std::uint64_t index) {
    return std::fmod((static_cast<double>(index & 0xFFFFFFFFu) + 0.5) * 0.7548776662466927, 1.0) < 0.5;
}

MeshSurface::MeshSurface(Triangles triangles) : triangles_(std::move(triangles)), tree_(triangles_) {
    double sum = 0.0;
    for (std::size_t t = 0; t < triangles_.count(); ++t) upto_.push_back(sum += std::sqrt(triangles_.area(t)));
}

MeshSurface::Point MeshSurface::at(double u, double v, bool front) const {
    const double x = u * weight();
    const auto found = std::upper_bound(upto_.begin(), upto_.end() - 1, x);
    const auto triangle = static_cast<std::size_t>(found - upto_.begin());
    const double before = triangle > 0 ? upto_[triangle - 1] : 0.0, own = upto_[triangle] - before;
    const double inside = own > 0.0 ? std::clamp((x - before) / own, 0.0, 1.0) : 0.5;
    const double root = std::sqrt(inside); // even over the triangle
    const double b1 = root * (1.0 - v), b2 = root * v;
    Point out{triangles_.position(triangle, b1, b2), triangles_.normal(triangle, b1, b2)};
    if (!front)
        for (double& n : out.normal) n = -n;
    return out;
}

} // namespace acdf::input
