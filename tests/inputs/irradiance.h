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

inline double length(const float a[3]) { return std::sqrt(dot(a, a)); }

/// An angle, with what is asked of it again and again.
struct Angle {
    double at, sine, cosine;
    double sine_square; ///< the integral of the square of the sine

    explicit Angle(double radians)
        : at(radians), sine(std::sin(radians)), cosine(std::cos(radians)), sine_square(0.5 * (at - sine * cosine)) {
    }
};

class ExactIrradiance {
public:
    /// `target` must live as long.
    explicit ExactIrradiance(const acdf::compress::Target& target) : target_(target) {
        if (octahedral()) {
            for (std::uint32_t r = 0; r < target.rows; ++r)
                for (std::uint32_t c = 0; c < target.columns; ++c) squares_.push_back(square(c, r));
            return;
        }
        for (reach_ = 0.5 * (2.0 * kPi / target.columns + kPi / target.rows); reach_ / parts_ >= 2e-3;) parts_ *= 2;
        const double steps = 2.0 * parts_; // middles are wanted, too
        for (std::uint32_t i = 0; i <= 2 * parts_ * target.columns; ++i)
            phi_.push_back(Angle(kPi - 2.0 * kPi * i / (steps * target.columns)));
        for (std::uint32_t i = 0; i <= 2 * parts_ * target.rows; ++i)
            theta_.push_back(Angle(kPi * i / (steps * target.rows)));
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
        return of_box(n, 2 * parts_ * column, 2 * parts_ * row, 2 * parts_);
    }

private:
    /// Of one texel of the octahedral square: the sum of its 8 x 8 directions, and how far they are from its mean.
    struct Square {
        double sum[3] = {0.0, 0.0, 0.0}, reach = 0.0;
    };

    bool octahedral() const { return target_.parameterization == ACDF_PARAM_OCTAHEDRAL; }

    /// Over so many steps of phi and theta: in closed form where no part is below the horizon, else of quarters,
    /// down to a 500th of a radian.
    double of_box(const double n[3], std::uint32_t i, std::uint32_t j, std::uint32_t steps) const {
        const std::uint32_t half = steps / 2;
        const Angle &phi = phi_[i + half], &theta = theta_[j + half];
        const double reach = reach_ * steps / (2.0 * parts_);
        const double middle = theta.sine * (n[0] * phi.cosine + n[1] * phi.sine) + n[2] * theta.cosine;
        if (middle <= -reach) return 0.0;
        if (middle < reach && half > 1)
            return of_box(n, i, j, half) + of_box(n, i + half, j, half) + of_box(n, i, j + half, half) +
                   of_box(n, i + half, j + half, half);
        if (middle <= 0.0) return 0.0;
        const Angle &phi0 = phi_[i], &phi1 = phi_[i + steps], &theta0 = theta_[j], &theta1 = theta_[j + steps];
        return (n[0] * (phi0.sine - phi1.sine) - n[1] * (phi0.cosine - phi1.cosine)) *
                   (theta1.sine_square - theta0.sine_square) +
               n[2] * (phi0.at - phi1.at) * 0.5 * (theta1.sine * theta1.sine - theta0.sine * theta0.sine);
    }

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
    double reach_ = 0.0;             ///< no part of a texel is farther from its middle
    std::uint32_t parts_ = 1;        ///< of each axis of a texel, a power of two: so that they reach less than that
    std::vector<Angle> phi_, theta_; ///< borders and middles of these parts
    std::vector<Square> squares_;
};

} // namespace acdf_test
