// The irradiance that a map gives to normals: all that does not depend on the normal is found once.
#pragma once

#include "tests/inputs/synthetic.h"

#include "compress/sum.h"
#include "compress/target.h"

#include <acdf/octahedral.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

namespace acdf_test {

using Normal = std::array<float, 3>;

inline double dot(const float a[3], const float b[3]) {
    return double{a[0]} * b[0] + double{a[1]} * b[1] + double{a[2]} * b[2];
}
inline double length(const float a[3]) { return std::sqrt(dot(a, a)); }

/// An angle, with what is asked of it again and again.
struct Angle {
    double at, sine, cosine;

    explicit Angle(double radians) : at(radians), sine(std::sin(radians)), cosine(std::cos(radians)) {}
    double sine_square() const { return 0.5 * (at - sine * cosine); } ///< the integral of the square of the sine
};

/// The integral of max(0, n . omega) over a box of phi (falling) and theta, n of unit length: in closed form where
/// no part is below the horizon, else of quarters, down to a 500th of a radian.
inline double clamped_cosine(const double n[3], const Angle& phi0, const Angle& phi1, const Angle& theta0,
                             const Angle& theta1) {
    const Angle phi(0.5 * (phi0.at + phi1.at)), theta(0.5 * (theta0.at + theta1.at));
    const double reach = 0.5 * (std::fabs(phi0.at - phi1.at) + std::fabs(theta1.at - theta0.at));
    const double middle = theta.sine * (n[0] * phi.cosine + n[1] * phi.sine) + n[2] * theta.cosine;
    if (middle <= -reach) return 0.0;
    if (middle >= reach || reach < 2e-3) {
        if (middle <= 0.0) return 0.0;
        return (n[0] * (phi0.sine - phi1.sine) - n[1] * (phi0.cosine - phi1.cosine)) *
                   (theta1.sine_square() - theta0.sine_square()) +
               n[2] * (phi0.at - phi1.at) * 0.5 * (theta1.sine * theta1.sine - theta0.sine * theta0.sine);
    }
    return clamped_cosine(n, phi0, phi, theta0, theta) + clamped_cosine(n, phi, phi1, theta0, theta) +
           clamped_cosine(n, phi0, phi, theta, theta1) + clamped_cosine(n, phi, phi1, theta, theta1);
}

class ExactIrradiance {
public:
    /// `target` must live as long.
    explicit ExactIrradiance(const acdf::compress::Target& target) : target_(target) {
        if (octahedral()) {
            for (std::uint32_t r = 0; r < target.rows; ++r)
                for (std::uint32_t c = 0; c < target.columns; ++c) squares_.push_back(square(c, r));
            return;
        }
        for (std::uint32_t c = 0; c <= target.columns; ++c)
            phi_.push_back(Angle(kPi - 2.0 * kPi * c / target.columns));
        for (std::uint32_t r = 0; r <= target.rows; ++r) theta_.push_back(Angle(kPi * r / target.rows));
        for (std::uint32_t c = 0; c < target.columns; ++c) {
            const Angle &phi0 = phi_[c], &phi1 = phi_[c + 1], middle(0.5 * (phi0.at + phi1.at));
            columns_.push_back({middle.cosine, middle.sine, phi0.sine - phi1.sine, phi0.cosine - phi1.cosine});
        }
        for (std::uint32_t r = 0; r < target.rows; ++r) {
            const Angle &theta0 = theta_[r], &theta1 = theta_[r + 1], middle(0.5 * (theta0.at + theta1.at));
            const double squares = theta1.sine * theta1.sine - theta0.sine * theta0.sine;
            rows_.push_back({middle.cosine, middle.sine, theta1.sine_square() - theta0.sine_square(),
                             (phi_[0].at - phi_[1].at) * 0.5 * squares});
        }
    }

    /// The integral of L max(0, n . omega) for a normal of any length.
    double operator()(const float normal[3]) const {
        acdf::compress::Sum sum;
        for (std::uint32_t r = 0; r < target_.rows; ++r)
            for (std::uint32_t c = 0; c < target_.columns; ++c)
                if (const float g = target_.row(r)[c]; g > 0.0f) sum.add(double{g} * of_texel(normal, c, r));
        return sum.value();
    }

    /// The integral of max(0, n . omega) over a texel.
    double of_texel(const float normal[3], std::uint32_t column, std::uint32_t row) const {
        const double size = length(normal);
        const double n[3] = {normal[0] / size, normal[1] / size, normal[2] / size};
        if (octahedral()) return of_square(n, column, row);
        const Axis &x = columns_[column], &y = rows_[row];
        const double reach = 0.5 * (2.0 * kPi / target_.columns + kPi / target_.rows);
        const double middle = y.sine * (n[0] * x.cosine + n[1] * x.sine) + n[2] * y.cosine;
        if (middle <= -reach) return 0.0;
        if (middle >= reach) return (n[0] * x.first - n[1] * x.second) * y.first + n[2] * y.second;
        return clamped_cosine(n, phi_[column], phi_[column + 1], theta_[row], theta_[row + 1]);
    }

private:
    /// Of one column or row: of its middle, and the two parts of the closed form of a box.
    struct Axis {
        double cosine, sine, first, second;
    };
    /// Of one texel of the octahedral square: the sum of its 8 x 8 directions, and how far they are from its mean.
    struct Square {
        double sum[3] = {0.0, 0.0, 0.0}, reach = 0.0;
    };

    bool octahedral() const { return target_.parameterization == ACDF_PARAM_OCTAHEDRAL; }

    void direction(std::uint32_t column, std::uint32_t row, int i, double d[3]) const {
        acdf_octahedral_direction((column + (i % 8 + 0.5) / 8) / target_.columns,
                                  (row + (i / 8 + 0.5) / 8) / target_.rows, d);
    }
    Square square(std::uint32_t column, std::uint32_t row) const {
        Square out;
        double d[3];
        for (int i = 0; i < 64; ++i) {
            direction(column, row, i, d);
            for (int k = 0; k < 3; ++k) out.sum[k] += d[k];
        }
        for (int i = 0; i < 64; ++i) {
            direction(column, row, i, d);
            for (int k = 0; k < 3; ++k) d[k] -= out.sum[k] / 64.0;
            out.reach = std::max(out.reach, std::sqrt(d[0] * d[0] + d[1] * d[1] + d[2] * d[2]));
        }
        return out;
    }
    /// By 8 x 8 directions, one by one only where the horizon is between them.
    double of_square(const double n[3], std::uint32_t column, std::uint32_t row) const {
        const Square& s = squares_[std::size_t{row} * target_.columns + column];
        const double area = 4.0 * kPi / target_.columns / target_.rows;
        double sum = n[0] * s.sum[0] + n[1] * s.sum[1] + n[2] * s.sum[2];
        if (sum <= -64.0 * s.reach) return 0.0;
        if (sum >= 64.0 * s.reach) return sum / 64.0 * area;
        sum = 0.0;
        for (int i = 0; i < 64; ++i) {
            double d[3];
            direction(column, row, i, d);
            sum += std::max(0.0, n[0] * d[0] + n[1] * d[1] + n[2] * d[2]);
        }
        return sum / 64.0 * area;
    }

    const acdf::compress::Target& target_;
    std::vector<Angle> phi_, theta_; ///< borders of columns and rows
    std::vector<Axis> columns_, rows_;
    std::vector<Square> squares_;
};

} // namespace acdf_test
