// A floor with a wall on it, in the light of a sky with a sun, and exact sums at its points: the judge of files
// that know what is hidden.
#pragma once

#include "tests/inputs/directions.h"
#include "tests/inputs/nearest_lookup.h"
#include "tests/inputs/sanitized.h"
#include "visibility/visible_view.h"

#include <acdf/builder.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <random>
#include <vector>

namespace walled_floor {

using namespace acdf;
using acdf_test::kPi;
using acdf_test::uniform;
using builder::VisibilityPoint;

constexpr int kColumns = 96, kRows = 48;

struct Offset {
    double x, y, z;
};

inline Offset direction_of(double column, double row) {
    const double theta = kPi * row / kRows, phi = kPi - 2.0 * kPi * column / kColumns;
    return {std::sin(theta) * std::cos(phi), std::sin(theta) * std::sin(phi), std::cos(theta)};
}

inline double radiance(int column, int row) {
    if (column >= 40 && column < 42 && row == 12) return 900.0; // a sun, 45 degrees above +x
    const Offset d = direction_of(column + 0.5, row + 0.5);
    return d.z < 0.0 ? 0.05 : 0.3 + d.z + 0.5 * ((column * 7 + row * 13) % 11) / 11.0 + (d.x > 0.7 ? 4.0 : 0.0);
}

inline const builder::Target& target() {
    static const builder::Target made =
        acdf::test::nearest_target(kColumns, kRows, [](auto c, auto r) { return radiance(int(c), int(r)); });
    return made;
}

/// A wall at x = 1, or one elsewhere, or none.
struct Wall {
    double x = 1.0, low = -3.0, high = 3.0, top = 2.0;

    bool hides(const float p[3], const float d[3]) const {
        const double t = (x - p[0]) / d[0];
        if (!(t > 1e-6) || !std::isfinite(t)) return false;
        const double y = p[1] + t * d[1], z = p[2] + t * d[2];
        return y > low && y < high && z > 0.0 && z < top;
    }
};

/// The floor from -4 to 4, and the wall's two sides.
inline bool point_of(std::uint64_t index, VisibilityPoint& point) {
    acdf_test::NumbersOf numbers(index);
    const float a = numbers.next(), b = numbers.next();
    if (index % 4 != 0) {
        point = {{8.0f * a - 4.0f, 8.0f * b - 4.0f, 0.0f}, {0.0f, 0.0f, 1.0f}};
    } else {
        const float side = index % 8 == 0 ? 1.0f : -1.0f;
        point = {{1.0f + 1e-3f * side, 6.0f * a - 3.0f, 2.0f * b}, {side, 0.0f, 0.0f}};
    }
    return true;
}

/// What arrives at a point, exactly (of light in the middles of texels), and the variance of one sample.
struct Exact {
    double irradiance = 0.0, variance = 0.0;
    int lost = 0; ///< texels whose light is never sampled
};

/// `cosine_samples`: beside each of the file's, by the balance heuristic.
inline Exact exact(const VisibleLocalView& view, const AcdfVisiblePoint& at, const VisibilityPoint& point,
                   const Wall& wall, double cosine_samples = 0.0) {
    Exact out;
    double square = 0.0;
    for (int r = 0; r < kRows; ++r)
        for (int c = 0; c < kColumns; ++c) {
            const Offset w = direction_of(c + 0.5, r + 0.5);
            const float d[3] = {float(w.x), float(w.y), float(w.z)};
            const double cosine =
                w.x * double{point.normal[0]} + w.y * double{point.normal[1]} + w.z * double{point.normal[2]};
            if (!(cosine > 0.0) || wall.hides(point.position, d)) continue;
            const double angle =
                2.0 * kPi / kColumns * (std::cos(kPi * r / kRows) - std::cos(kPi * (r + 1) / kRows));
            const double f = radiance(c, r) * cosine, p = double{view.pdf(at, d)} + cosine_samples * cosine / kPi;
            out.irradiance += f * angle;
            out.lost += !(p > 0.0);
            if (p > 0.0) square += f * f / p * angle;
        }
    out.variance = square - out.irradiance * out.irradiance;
    return out;
}

/// The texel that a direction lies in, and its middle: what `exact` sums.
inline double sampled(const VisibleLocalView& view, const AcdfVisiblePoint& at, const VisibilityPoint& point,
                      const Wall& wall, double u0, double u1) {
    const DirectionSample s = view.sample(at, u0, u1);
    if (!(s.pdf > 0.0f)) return 0.0;
    const double theta = std::acos(double{s.direction[2]}),
                 phi = std::atan2(double{s.direction[1]}, double{s.direction[0]});
    const int r = std::min(int(theta / kPi * kRows), kRows - 1),
              c = std::min(int((kPi - phi) / (2.0 * kPi) * kColumns), kColumns - 1);
    const Offset w = direction_of(c + 0.5, r + 0.5);
    const float d[3] = {float(w.x), float(w.y), float(w.z)};
    const double cosine =
        w.x * double{point.normal[0]} + w.y * double{point.normal[1]} + w.z * double{point.normal[2]};
    if (!(cosine > 0.0) || wall.hides(point.position, d)) return 0.0;
    return radiance(c, r) * cosine / double{s.pdf};
}

/// Monte Carlo against summation at `count` points: how far the mean of all deviations, in their standard errors,
/// is off, and the root of their mean square, which is 1 where both are right.
inline void expect_unbiased(const VisibleLocalView& view, const Wall& wall, int count) {
    constexpr int samples = 2000;
    count = acdf_test::repeated(count);
    std::mt19937_64 random(3);
    double sum = 0.0, square = 0.0;
    for (int i = 0; i < count; ++i) {
        VisibilityPoint point;
        point_of(1000003 + std::uint64_t(i), point);
        const AcdfVisiblePoint at = view.at(point.position, point.normal);
        EXPECT_TRUE(at.in_cell);
        const Exact truth = exact(view, at, point, wall);
        EXPECT_EQ(truth.lost, 0);
        double mean = 0.0;
        for (int k = 0; k < samples; ++k)
            mean += sampled(view, at, point, wall, uniform(random), uniform(random)) / samples;
        const double error =
            std::sqrt(std::max(truth.variance, 1e-9 * truth.irradiance * truth.irradiance) / samples);
        const double z = error > 0.0 ? (mean - truth.irradiance) / error : mean;
        sum += z;
        square += z * z;
    }
    EXPECT_LT(std::fabs(sum / std::sqrt(count)), 4.0);
    EXPECT_NEAR(std::sqrt(square / count), 1.0, std::max(0.2, 4.8 / std::sqrt(2.0 * count)));
}

} // namespace walled_floor
