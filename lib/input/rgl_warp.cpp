#include "input/rgl_warp.h"

#include <algorithm>
#include <cmath>

namespace acdf::input {
namespace {

/// Where between two neighbours `value` lies.
struct Interval {
    std::size_t low = 0;
    double t = 0.0;
};

Interval find_node(const std::vector<float>& nodes, double value) {
    if (nodes.size() < 2) return {};
    const auto above = std::upper_bound(nodes.begin() + 1, nodes.end() - 1, value,
                                        [](double v, float node) { return v < static_cast<double>(node); });
    const double low = static_cast<double>(above[-1]), high = static_cast<double>(above[0]);
    return {static_cast<std::size_t>(above - nodes.begin()) - 1,
            std::clamp((value - low) / (high - low), 0.0, 1.0)};
}

Interval find_cell(double position, std::size_t corners) {
    const double scaled = std::clamp(position, 0.0, 1.0) * static_cast<double>(corners - 1);
    const std::size_t low = std::min(static_cast<std::size_t>(scaled), corners - 2);
    return {low, scaled - static_cast<double>(low)};
}

/// The last of 0 .. corners - 2 at which the increasing function `cdf` is below u.
template <class Cdf>
std::size_t search(std::size_t corners, double u, const Cdf& cdf) {
    std::size_t low = 0, high = corners - 1;
    while (high - low > 1) {
        const std::size_t middle = (low + high) / 2;
        (cdf(middle) < u ? low : high) = middle;
    }
    return low;
}

/// t in [0, 1] with integral s from 0 to t of the line from a to b, without cancellation.
double invert_line(double a, double b, double s) {
    const double root = a + std::sqrt(std::max(0.0, a * a + 2.0 * s * (b - a)));
    return root > 0.0 ? std::clamp(2.0 * s / root, 0.0, 1.0) : 0.5;
}

double mix_of(const std::vector<float>& values, const RglMix& mix, std::size_t stride, std::size_t index) {
    double sum = 0.0;
    for (std::size_t k = 0; k < mix.count; ++k)
        sum += mix.weight[k] * static_cast<double>(values[mix.slice[k] * stride + index]);
    return sum;
}

double lerp(double a, double b, double t) { return (1.0 - t) * a + t * b; }

} // namespace

RglMix RglNodes::mix(double view_phi, double view_theta) const {
    const Interval p = find_node(phi, view_phi), t = find_node(theta, view_theta);
    RglMix out;
    for (std::size_t i = 0; i < 2; ++i)
        for (std::size_t j = 0; j < 2; ++j) {
            const double weight = (i ? p.t : 1.0 - p.t) * (j ? t.t : 1.0 - t.t);
            if (!(weight > 0.0)) continue;
            out.slice[out.count] = (p.low + i) * theta.size() + t.low + j;
            out.weight[out.count++] = weight;
        }
    return out;
}

double RglTable::at(const RglMix& mix, std::size_t index, std::size_t channel) const {
    return mix_of(values, mix, channels * slice_size(), channel * slice_size() + index);
}

double RglTable::bilinear(const RglMix& mix, double x, double y, std::size_t channel) const {
    const Interval column = find_cell(x, columns), row = find_cell(y, rows);
    const std::size_t corner = row.low * columns + column.low;
    return lerp(lerp(at(mix, corner, channel), at(mix, corner + 1, channel), column.t),
                lerp(at(mix, corner + columns, channel), at(mix, corner + columns + 1, channel), column.t), row.t);
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

double RglWarp::marginal(const RglMix& mix, std::size_t row) const {
    return mix_of(marginal_, mix, density_.rows, row);
}

double RglWarp::conditional(const RglMix& mix, std::size_t row, std::size_t column, double t) const {
    const std::size_t i = row * density_.columns + column, size = density_.slice_size();
    return lerp(mix_of(conditional_, mix, size, i), mix_of(conditional_, mix, size, i + density_.columns), t);
}

double RglWarp::row_mass(const RglMix& mix, std::size_t row) const {
    return mix_of(conditional_, mix, density_.slice_size(), (row + 1) * density_.columns - 1);
}

double RglWarp::pdf(const RglMix& mix, double x, double y) const { return density_.bilinear(mix, x, y) * cells(); }

RglWarp::Point RglWarp::sample(const RglMix& mix, double u, double v) const {
    constexpr double tiny = 0x1p-24; // steps over leading cells without mass, as published
    u = std::clamp(u, tiny, 1.0 - tiny);
    v = std::clamp(v, tiny, 1.0 - tiny);
    const std::size_t row = search(density_.rows, v, [&](std::size_t i) { return marginal(mix, i); });
    const double t = invert_line(row_mass(mix, row), row_mass(mix, row + 1), v - marginal(mix, row));

    u *= conditional(mix, row, density_.columns - 1, t);
    const auto cdf = [&](std::size_t i) { return conditional(mix, row, i, t); };
    const std::size_t column = search(density_.columns, u, cdf);
    const std::size_t corner = row * density_.columns + column;
    const double a = lerp(density_.at(mix, corner), density_.at(mix, corner + density_.columns), t);
    const double b = lerp(density_.at(mix, corner + 1), density_.at(mix, corner + density_.columns + 1), t);
    const double s = invert_line(a, b, u - cdf(column));
    return {(static_cast<double>(column) + s) / static_cast<double>(density_.columns - 1),
            (static_cast<double>(row) + t) / static_cast<double>(density_.rows - 1), lerp(a, b, s) * cells()};
}

RglWarp::Point RglWarp::invert(const RglMix& mix, double x, double y) const {
    const Interval column = find_cell(x, density_.columns), row = find_cell(y, density_.rows);
    const std::size_t corner = row.low * density_.columns + column.low;
    const double a = lerp(density_.at(mix, corner), density_.at(mix, corner + density_.columns), row.t);
    const double b = lerp(density_.at(mix, corner + 1), density_.at(mix, corner + density_.columns + 1), row.t);
    const double left = conditional(mix, row.low, column.low, row.t) + column.t * (a + 0.5 * column.t * (b - a));
    const double whole = conditional(mix, row.low, density_.columns - 1, row.t);
    const double r0 = row_mass(mix, row.low), r1 = row_mass(mix, row.low + 1);
    const double below = marginal(mix, row.low) + row.t * (r0 + 0.5 * row.t * (r1 - r0));
    return {whole > 0.0 ? std::clamp(left / whole, 0.0, 1.0) : 0.5, std::clamp(below, 0.0, 1.0),
            lerp(a, b, column.t) * cells()};
}

std::size_t RglWarp::bytes() const {
    return sizeof(float) * (density_.values.size() + marginal_.size() + conditional_.size());
}

} // namespace acdf::input
