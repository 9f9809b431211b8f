#include "input/brdf/rgl_warp.h"

#include <algorithm>
#include <cmath>

namespace acdf::input {
namespace {

/// Where between two neighbours `value` lies.
template <class Real>
struct Interval {
    std::size_t low = 0;
    Real t = 0;
};

template <class Real>
Interval<Real> find_node(const std::vector<float>& nodes, Real value) {
    if (nodes.size() < 2) return {};
    const auto above = std::upper_bound(nodes.begin() + 1, nodes.end() - 1, value,
                                        [](Real v, float node) { return v < static_cast<Real>(node); });
    const Real low = static_cast<Real>(above[-1]), high = static_cast<Real>(above[0]);
    return {static_cast<std::size_t>(above - nodes.begin()) - 1,
            std::clamp((value - low) / (high - low), Real(0), Real(1))};
}

template <class Real>
Interval<Real> find_cell(Real position, std::size_t corners) {
    const Real scaled = std::clamp(position, Real(0), Real(1)) * static_cast<Real>(corners - 1);
    const std::size_t low = std::min(static_cast<std::size_t>(scaled), corners - 2);
    return {low, scaled - static_cast<Real>(low)};
}

/// The last of 0 .. corners - 2 at which the increasing function `cdf` is below u.
template <class Real, class Cdf>
std::size_t search(std::size_t corners, Real u, const Cdf& cdf) {
    std::size_t low = 0, high = corners - 1;
    while (high - low > 1) {
        const std::size_t middle = (low + high) / 2;
        (cdf(middle) < u ? low : high) = middle;
    }
    return low;
}

/// t in [0, 1] with integral s from 0 to t of the line from a to b, without cancellation.
template <class Real>
Real invert_line(Real a, Real b, Real s) {
    const Real root = a + std::sqrt(std::max(Real(0), a * a + 2 * s * (b - a)));
    return root > 0 ? std::clamp(2 * s / root, Real(0), Real(1)) : Real(0.5);
}

template <class Real>
Real mix_of(const std::vector<float>& values, const RglMix<Real>& mix, std::size_t stride, std::size_t index) {
    Real sum = 0;
    for (std::size_t k = 0; k < mix.count; ++k)
        sum += mix.weight[k] * static_cast<Real>(values[mix.slice[k] * stride + index]);
    return sum;
}

template <class Real>
Real lerp(Real a, Real b, Real t) {
    return (1 - t) * a + t * b;
}

} // namespace

template <class Real>
RglMix<Real> RglNodes::mix(Real view_phi, Real view_theta) const {
    const Interval<Real> p = find_node(phi, view_phi), t = find_node(theta, view_theta);
    RglMix<Real> out;
    for (std::size_t i = 0; i < 2; ++i)
        for (std::size_t j = 0; j < 2; ++j) {
            const Real weight = (i ? p.t : 1 - p.t) * (j ? t.t : 1 - t.t);
            if (!(weight > 0)) continue;
            out.slice[out.count] = (p.low + i) * theta.size() + t.low + j;
            out.weight[out.count++] = weight;
        }
    return out;
}

template <class Real>
Real RglTable::at(const RglMix<Real>& mix, std::size_t index, std::size_t channel) const {
    return mix_of(values, mix, channels * slice_size(), channel * slice_size() + index);
}

template <class Real>
RglTable::Place<Real> RglTable::place(Real x, Real y) const {
    const Interval<Real> column = find_cell(x, columns), row = find_cell(y, rows);
    return {row.low * columns + column.low, column.t, row.t};
}

template <class Real>
Real RglTable::bilinear(const RglMix<Real>& mix, const Place<Real>& p, std::size_t channel) const {
    return lerp(lerp(at(mix, p.corner, channel), at(mix, p.corner + 1, channel), p.column),
                lerp(at(mix, p.corner + columns, channel), at(mix, p.corner + columns + 1, channel), p.column),
                p.row);
}

RglWarp::RglWarp(RglTable table) : density_(std::move(table)) {
    const std::size_t columns = density_.columns, rows = density_.rows, size = density_.slice_size();
    const std::size_t slices = density_.values.size() / size;
    marginal_.resize(slices * rows);
    conditional_.resize(slices * size);
    std::vector<double> left(size), below(rows);
    for (std::size_t s = 0; s < slices; ++s) {
        float* const value = &density_.values[s * size];
        for (std::size_t r = 0; r < rows; ++r)
            for (std::size_t c = 1; c < columns; ++c) {
                const std::size_t i = r * columns + c;
                left[i] = left[i - 1] + 0.5 * (static_cast<double>(value[i - 1]) + static_cast<double>(value[i]));
            }
        for (std::size_t r = 1; r < rows; ++r)
            below[r] = below[r - 1] + 0.5 * (left[r * columns - 1] + left[(r + 1) * columns - 1]);
        const double scale = 1.0 / below[rows - 1];
        for (std::size_t r = 0; r < rows; ++r) marginal_[s * rows + r] = static_cast<float>(below[r] * scale);
        for (std::size_t i = 0; i < size; ++i) {
            conditional_[s * size + i] = static_cast<float>(left[i] * scale);
            value[i] = static_cast<float>(static_cast<double>(value[i]) * scale);
        }
    }
}

template <class Real>
Real RglWarp::marginal(const RglMix<Real>& mix, std::size_t row) const {
    return mix_of(marginal_, mix, density_.rows, row);
}

template <class Real>
Real RglWarp::conditional(const RglMix<Real>& mix, std::size_t row, std::size_t column, Real t) const {
    const std::size_t i = row * density_.columns + column, size = density_.slice_size();
    return lerp(mix_of(conditional_, mix, size, i), mix_of(conditional_, mix, size, i + density_.columns), t);
}

template <class Real>
Real RglWarp::row_mass(const RglMix<Real>& mix, std::size_t row) const {
    return mix_of(conditional_, mix, density_.slice_size(), (row + 1) * density_.columns - 1);
}

template <class Real>
Real RglWarp::pdf(const RglMix<Real>& mix, Real x, Real y) const {
    return density_.bilinear(mix, density_.place(x, y)) * cells<Real>();
}

template <class Real>
RglWarp::Point<Real> RglWarp::sample(const RglMix<Real>& mix, Real u, Real v) const {
    constexpr Real tiny = Real(0x1p-24); // steps over leading cells without mass, as published
    u = std::clamp(u, tiny, 1 - tiny);
    v = std::clamp(v, tiny, 1 - tiny);
    const std::size_t row = search(density_.rows, v, [&](std::size_t i) { return marginal(mix, i); });
    const Real t = invert_line(row_mass(mix, row), row_mass(mix, row + 1), v - marginal(mix, row));

    u *= conditional(mix, row, density_.columns - 1, t);
    const auto cdf = [&](std::size_t i) { return conditional(mix, row, i, t); };
    const std::size_t column = search(density_.columns, u, cdf);
    const std::size_t corner = row * density_.columns + column;
    const Real a = lerp(density_.at(mix, corner), density_.at(mix, corner + density_.columns), t);
    const Real b = lerp(density_.at(mix, corner + 1), density_.at(mix, corner + density_.columns + 1), t);
    const Real s = invert_line(a, b, u - cdf(column));
    return {(static_cast<Real>(column) + s) / static_cast<Real>(density_.columns - 1),
            (static_cast<Real>(row) + t) / static_cast<Real>(density_.rows - 1), lerp(a, b, s) * cells<Real>()};
}

template <class Real>
RglWarp::Point<Real> RglWarp::invert(const RglMix<Real>& mix, Real x, Real y) const {
    const Interval<Real> column = find_cell(x, density_.columns), row = find_cell(y, density_.rows);
    const std::size_t corner = row.low * density_.columns + column.low;
    const Real a = lerp(density_.at(mix, corner), density_.at(mix, corner + density_.columns), row.t);
    const Real b = lerp(density_.at(mix, corner + 1), density_.at(mix, corner + density_.columns + 1), row.t);
    const Real left =
        conditional(mix, row.low, column.low, row.t) + column.t * (a + Real(0.5) * column.t * (b - a));
    const Real whole = conditional(mix, row.low, density_.columns - 1, row.t);
    const Real r0 = row_mass(mix, row.low), r1 = row_mass(mix, row.low + 1);
    const Real below = marginal(mix, row.low) + row.t * (r0 + Real(0.5) * row.t * (r1 - r0));
    return {whole > 0 ? std::clamp(left / whole, Real(0), Real(1)) : Real(0.5), std::clamp(below, Real(0), Real(1)),
            lerp(a, b, column.t) * cells<Real>()};
}

std::size_t RglWarp::bytes() const {
    return sizeof(float) * (density_.values.size() + marginal_.size() + conditional_.size());
}

#define INSTANTIATE(Real)                                                                                          \
    template RglMix<Real> RglNodes::mix(Real, Real) const;                                                         \
    template Real RglTable::at(const RglMix<Real>&, std::size_t, std::size_t) const;                               \
    template RglTable::Place<Real> RglTable::place(Real, Real) const;                                              \
    template Real RglTable::bilinear(const RglMix<Real>&, const Place<Real>&, std::size_t) const;                  \
    template Real RglWarp::pdf(const RglMix<Real>&, Real, Real) const;                                             \
    template RglWarp::Point<Real> RglWarp::sample(const RglMix<Real>&, Real, Real) const;                          \
    template RglWarp::Point<Real> RglWarp::invert(const RglMix<Real>&, Real, Real) const;
INSTANTIATE(float)
INSTANTIATE(double)
#undef INSTANTIATE

} // namespace acdf::input
