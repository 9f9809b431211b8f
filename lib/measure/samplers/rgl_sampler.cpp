#include "measure/samplers/rgl_sampler.h"

#include <acdf/elementary.h>

#include <algorithm>
#include <cmath>

namespace acdf::measure {
namespace {

template <class Real>
constexpr Real kPi = Real(ACDF_PI);

template <class Real>
struct Vector {
    explicit Vector(const double v[3])
        : x{static_cast<Real>(v[0]), static_cast<Real>(v[1]), static_cast<Real>(v[2])} {}
    Real x[3];
};

} // namespace

template <class Real>
BrdfSample RglSamplerOf<Real>::sample(const double wo[3], const double u[2]) const {
    BrdfSample out;
    if (!(wo[2] > 0.0)) return out;
    const auto view = input::rgl_view(tables_, Vector<Real>(wo).x);
    const auto bright = tables_.luminance.sample(view.mix, static_cast<Real>(u[0]), static_cast<Real>(u[1]));
    const auto normal = tables_.vndf.sample(view.mix, bright.x, bright.y);

    const Real theta = normal.x * normal.x * (kPi<Real> / 2), sine = std::sin(theta);
    const Real phi = (2 * normal.y - 1) * kPi<Real> + (tables_.isotropic ? view.phi : Real(0));
    const Real m[3] = {sine * std::cos(phi), sine * std::sin(phi), std::cos(theta)};
    const Real dot = view.wo[0] * m[0] + view.wo[1] * m[1] + view.wo[2] * m[2];
    Real wi[3];
    for (int k = 0; k < 3; ++k) wi[k] = 2 * dot * m[k] - view.wo[k];
    view.fold(wi);
    std::copy(wi, wi + 3, out.wi);
    if (!(wi[2] > 0)) return out;
    const Real jacobian = std::max(2 * kPi<Real> * kPi<Real> * normal.x * sine, Real(1e-6)) * 4 * dot;
    out.pdf = static_cast<double>(bright.pdf * normal.pdf / jacobian);
    return out;
}

template <class Real>
double RglSamplerOf<Real>::pdf(const double wo[3], const double wi[3]) const {
    if (!(wo[2] > 0.0 && wi[2] > 0.0)) return 0.0;
    const auto view = input::rgl_view(tables_, Vector<Real>(wo).x);
    const auto half = input::rgl_half(tables_, view, Vector<Real>(wi).x);
    const auto point = tables_.vndf.invert(view.mix, half.x, half.y);
    return static_cast<double>(tables_.luminance.pdf(view.mix, point.x, point.y) * point.pdf / half.jacobian);
}

template class RglSamplerOf<float>;
template class RglSamplerOf<double>;

} // namespace acdf::measure
