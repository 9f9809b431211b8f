#include "input/mesh/placement.h"

#include <cmath>

namespace acdf::input {
namespace {

/// Of the linear part.
double cofactor(const Placement& placement, std::size_t i, std::size_t k) {
    const auto at = [&](std::size_t row, std::size_t column) {
        return placement.rows[(i + row) % 3][(k + column) % 3];
    };
    return at(1, 1) * at(2, 2) - at(1, 2) * at(2, 1);
}

} // namespace

double Placement::determinant() const {
    double sum = 0.0;
    for (std::size_t k = 0; k < 3; ++k) sum += rows[0][k] * cofactor(*this, 0, k);
    return sum;
}

std::array<float, 3> Placement::position(const std::array<float, 3>& p) const {
    if (stays()) return p;
    std::array<float, 3> out{};
    for (std::size_t i = 0; i < 3; ++i)
        out[i] = static_cast<float>(rows[i][0] * double{p[0]} + rows[i][1] * double{p[1]} +
                                    rows[i][2] * double{p[2]} + rows[i][3]);
    return out;
}

std::array<float, 3> Placement::normal(const std::array<float, 3>& n) const {
    if (stays()) return n;
    std::array<double, 3> sum{};
    double square = 0.0;
    for (std::size_t i = 0; i < 3; ++i) {
        for (std::size_t k = 0; k < 3; ++k) sum[i] += cofactor(*this, i, k) * double{n[k]};
        square += sum[i] * sum[i];
    }
    const double scale =
        square > 0.0 && std::isfinite(square) ? std::copysign(1.0, determinant()) / std::sqrt(square) : 0.0;
    return {static_cast<float>(scale * sum[0]), static_cast<float>(scale * sum[1]),
            static_cast<float>(scale * sum[2])};
}

} // namespace acdf::input
