#include "input/rgl_brdf.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace acdf::input {
namespace {

constexpr double pi = 3.14159265358979323846;

double angle_from_z(const double w[3]) { return std::atan2(std::hypot(w[0], w[1]), w[2]); }

double theta_coordinate(double theta) { return std::sqrt(theta * (2.0 / pi)); }

} // namespace

RglView rgl_view(const RglTables& tables, const double wo[3]) {
    RglView view;
    std::copy(wo, wo + 3, view.wo);
    if (tables.reduction >= 2) { // the nodes lie where y (and x) are negative
        view.sign_y = std::signbit(wo[1]) ? 1.0 : -1.0;
        view.sign_x = tables.reduction == 4 ? (std::signbit(wo[0]) ? 1.0 : -1.0) : view.sign_y;
        view.fold(view.wo);
    }
    view.theta = angle_from_z(view.wo);
    view.phi = std::atan2(view.wo[1], view.wo[0]);
    view.mix = tables.nodes.mix(view.phi, view.theta);
    return view;
}

RglHalf rgl_half(const RglTables& tables, const RglView& view, const double wi[3]) {
    double m[3] = {wi[0], wi[1], wi[2]};
    view.fold(m);
    for (int i = 0; i < 3; ++i) m[i] += view.wo[i];
    const double length = std::sqrt(m[0] * m[0] + m[1] * m[1] + m[2] * m[2]);
    for (double& x : m) x /= length;

    RglHalf half;
    half.x = theta_coordinate(angle_from_z(m));
    const double phi = std::atan2(m[1], m[0]) - (tables.isotropic ? view.phi : 0.0);
    half.y = (phi + pi) / (2.0 * pi);
    half.y -= std::floor(half.y);
    const double dot = view.wo[0] * m[0] + view.wo[1] * m[1] + view.wo[2] * m[2];
    // The bound is the authors'; it only matters within 1e-5 of the pole.
    half.jacobian = std::max(2.0 * pi * pi * half.x * std::hypot(m[0], m[1]), 1e-6) * 4.0 * dot;
    return half;
}

RglBrdf::RglBrdf(RglTables tables) : tables_(std::move(tables)) {
    isotropic = tables_.isotropic && tables_.nodes.phi.size() == 1;
    asymmetry = tables_.asymmetry;
    mirror = isotropic && asymmetry <= 1e-3;
    notes = tables_.notes;
}

void RglBrdf::evaluate(const double wo[3], const double wi[3], double rgb[3]) const {
    std::fill(rgb, rgb + 3, 0.0);
    if (!(wo[2] > 0.0 && wi[2] > 0.0)) return;
    const RglView view = rgl_view(tables_, wo);
    const RglHalf half = rgl_half(tables_, view, wi);
    const RglWarp::Point point = tables_.vndf.invert(view.mix, half.x, half.y);
    double scale = 1.0 / wi[2]; // the tables hold rho cos(theta_i)
    if (tables_.jacobian) {
        const RglMix only = {{0}, {1.0}, 1};
        const double view_y = (view.phi + pi) / (2.0 * pi);
        scale *= tables_.ndf.bilinear(only, half.x, half.y) /
                 (4.0 * tables_.sigma.bilinear(only, theta_coordinate(view.theta), view_y));
    }
    for (std::size_t c = 0; c < 3; ++c) {
        const double value = tables_.colour.bilinear(view.mix, point.x, point.y, c) * scale;
        if (value > 0.0) rgb[c] = std::min(value, std::numeric_limits<double>::max());
    }
}

} // namespace acdf::input
