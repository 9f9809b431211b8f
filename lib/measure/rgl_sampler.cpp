#include "measure/rgl_sampler.h"

#include <algorithm>
#include <cmath>

namespace acdf::measure {
namespace {

constexpr double pi = 3.14159265358979323846;

} // namespace

BrdfSample RglSampler::sample(const double wo[3], const double u[2]) const {
    BrdfSample out;
    if (!(wo[2] > 0.0)) return out;
    const input::RglView view = input::rgl_view(tables_, wo);
    const auto bright = tables_.luminance.sample(view.mix, u[0], u[1]);
    const auto normal = tables_.vndf.sample(view.mix, bright.x, bright.y);

    const double theta = normal.x * normal.x * (0.5 * pi);
    const double phi = (2.0 * normal.y - 1.0) * pi + (tables_.isotropic ? view.phi : 0.0);
    const double m[3] = {std::sin(theta) * std::cos(phi), std::sin(theta) * std::sin(phi), std::cos(theta)};
    const double dot = view.wo[0] * m[0] + view.wo[1] * m[1] + view.wo[2] * m[2];
    for (int k = 0; k < 3; ++k) out.wi[k] = 2.0 * dot * m[k] - view.wo[k];
    view.fold(out.wi);
    if (!(out.wi[2] > 0.0)) return out;
    const double jacobian = std::max(2.0 * pi * pi * normal.x * std::sin(theta), 1e-6) * 4.0 * dot;
    out.pdf = bright.pdf * normal.pdf / jacobian;
    return out;
}

double RglSampler::pdf(const double wo[3], const double wi[3]) const {
    if (!(wo[2] > 0.0 && wi[2] > 0.0)) return 0.0;
    const input::RglView view = input::rgl_view(tables_, wo);
    const input::RglHalf half = input::rgl_half(tables_, view, wi);
    const auto point = tables_.vndf.invert(view.mix, half.x, half.y);
    return tables_.luminance.pdf(view.mix, point.x, point.y) * point.pdf / half.jacobian;
}

} // namespace acdf::measure
