#include "input/brdf/rgl.h"

#include "compress/trigonometry.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstdint>
#include <limits>

namespace acdf::input {
namespace {

template <class Real>
constexpr Real half_turn = static_cast<Real>(compress::pi);

template <class Real>
Real angle_from_z(const Real w[3]) {
    return std::atan2(compress::norm(w[0], w[1]), w[2]);
}

template <class Real>
Real theta_coordinate(Real theta) {
    return std::sqrt(theta * (2 / half_turn<Real>));
}

} // namespace

template <class Real>
RglView<Real> rgl_view(const RglTables& tables, const Real wo[3]) {
    RglView<Real> view;
    std::copy(wo, wo + 3, view.wo);
    if (tables.reduction >= 2) { // the nodes lie where y (and x) are negative
        view.sign_y = std::signbit(wo[1]) ? Real(1) : Real(-1);
        view.sign_x = tables.reduction == 4 ? (std::signbit(wo[0]) ? Real(1) : Real(-1)) : view.sign_y;
        view.fold(view.wo);
    }
    view.theta = angle_from_z(view.wo);
    view.phi = std::atan2(view.wo[1], view.wo[0]);
    view.mix = tables.nodes.mix(view.phi, view.theta);
    return view;
}

template <class Real>
RglHalf<Real> rgl_half(const RglTables& tables, const RglView<Real>& view, const Real wi[3]) {
    Real m[3] = {wi[0], wi[1], wi[2]};
    view.fold(m);
    for (int i = 0; i < 3; ++i) m[i] += view.wo[i];
    const Real length = std::sqrt(m[0] * m[0] + m[1] * m[1] + m[2] * m[2]);
    for (Real& x : m) x /= length;

    RglHalf<Real> half;
    half.x = theta_coordinate(angle_from_z(m));
    const Real phi = std::atan2(m[1], m[0]) - (tables.isotropic ? view.phi : Real(0));
    half.y = (phi + half_turn<Real>) / (2 * half_turn<Real>);
    half.y -= std::floor(half.y);
    const Real dot = view.wo[0] * m[0] + view.wo[1] * m[1] + view.wo[2] * m[2];
    // The bound is the authors'; it only matters within 1e-5 of the pole.
    half.jacobian =
        std::max(2 * half_turn<Real> * half_turn<Real> * half.x * compress::norm(m[0], m[1]), Real(1e-6)) * 4 * dot;
    return half;
}

#define INSTANTIATE(Real)                                                                                          \
    template RglView<Real> rgl_view(const RglTables&, const Real[3]);                                              \
    template RglHalf<Real> rgl_half(const RglTables&, const RglView<Real>&, const Real[3]);
INSTANTIATE(float)
INSTANTIATE(double)
#undef INSTANTIATE

namespace {

/// What a BRDF needs of a view, which mostly is that of the evaluation before.
struct LastView {
    std::uint64_t brdf = 0; ///< its number
    double wo[3] = {0.0, 0.0, 0.0};
    RglView<double> view;
    double area = 0.0; ///< projected, where the tables hold it apart

    bool is(std::uint64_t number, const double of[3]) const {
        return brdf == number && wo[0] == of[0] && wo[1] == of[1] && wo[2] == of[2];
    }
};

constexpr RglMix<double> kOnly = {{0}, {1.0}, 1};

double projected_area(const RglTables& tables, const RglView<double>& view) {
    const double y = (view.phi + compress::pi) / (2.0 * compress::pi);
    return tables.sigma.bilinear(kOnly, tables.sigma.place(theta_coordinate(view.theta), y));
}

std::uint64_t next_number() {
    static std::atomic<std::uint64_t> last{0};
    return ++last;
}

} // namespace

RglBrdf::RglBrdf(RglTables tables) : tables_(std::move(tables)), number_(next_number()) {
    isotropic = tables_.isotropic && tables_.nodes.phi.size() == 1;
    asymmetry = tables_.asymmetry;
    mirror = isotropic && asymmetry <= 1e-3;
    notes = tables_.notes;
}

void RglBrdf::evaluate(const double wo[3], const double wi[3], double rgb[3]) const {
    std::fill(rgb, rgb + 3, 0.0);
    if (!(wo[2] > 0.0 && wi[2] > 0.0)) return;
    thread_local LastView last;
    if (!last.is(number_, wo)) {
        last = {number_, {wo[0], wo[1], wo[2]}, rgl_view(tables_, wo), 0.0};
        if (tables_.jacobian) last.area = projected_area(tables_, last.view);
    }
    const RglView<double>& view = last.view;
    const auto half = rgl_half(tables_, view, wi);
    const auto point = tables_.vndf.invert(view.mix, half.x, half.y);
    double scale = 1.0 / wi[2]; // the tables hold rho cos(theta_i)
    if (tables_.jacobian)
        scale *= tables_.ndf.bilinear(kOnly, tables_.ndf.place(half.x, half.y)) / (4.0 * last.area);
    const auto place = tables_.colour.place(point.x, point.y);
    for (std::size_t c = 0; c < 3; ++c) {
        const double value = tables_.colour.bilinear(view.mix, place, c) * scale;
        if (value > 0.0) rgb[c] = std::min(value, std::numeric_limits<double>::max());
    }
}

} // namespace acdf::input
