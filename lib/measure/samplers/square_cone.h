// The cone around a box of the octahedral square: what a tile there sees of a normal, in a few operations.
// compress::largest_octahedral_cosine is nearer, and looks at points of the box for each normal.
#pragma once

#include <acdf/octahedral.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <vector>

namespace acdf::measure {

/// All directions of a box lie within an angle of `axis`.
struct SquareCone {
    std::array<double, 3> axis{};
    double cosine = 1.0, sine = 0.0; ///< of that angle, at most pi

    /// Around low[0] <= u <= high[0], low[1] <= v <= high[1] of the unit square: around points of it, and wider by
    /// how far others can be from the nearest of these.
    static SquareCone around(const double low[2], const double high[2]) {
        constexpr std::size_t n = 33; // points a side
        std::vector<std::array<double, 3>> points(n * n);
        SquareCone out;
        for (std::size_t i = 0; i < n * n; ++i) {
            const auto at = [&](int k, std::size_t step) {
                return low[k] + (high[k] - low[k]) * static_cast<double>(step) / (n - 1.0);
            };
            acdf_octahedral_direction(at(0, i % n), at(1, i / n), points[i].data());
            for (std::size_t k = 0; k < 3; ++k) out.axis[k] += points[i][k];
        }
        const double length = std::sqrt(dot(out.axis, out.axis));
        for (double& v : out.axis) v = length > 1e-6 ? v / length : 0.0;
        double least = 1.0, gap[2] = {0.0, 0.0};
        for (std::size_t i = 0; i < n * n; ++i) {
            least = std::min(least, dot(out.axis, points[i]));
            if (i % n + 1 < n) gap[0] = std::max(gap[0], angle(dot(points[i], points[i + 1])));
            if (i + n < n * n) gap[1] = std::max(gap[1], angle(dot(points[i], points[i + n])));
        }
        const double width = length > 1e-6 ? angle(least) + 0.5 * (gap[0] + gap[1]) : ACDF_PI;
        out.cosine = std::cos(std::min(width, ACDF_PI));
        out.sine = std::sin(std::min(width, ACDF_PI));
        return out;
    }

    /// A cosine that no direction of the cone exceeds with unit n.
    double largest_cosine(const float n[3]) const {
        const double c = axis[0] * n[0] + axis[1] * n[1] + axis[2] * n[2];
        return c >= cosine ? 1.0 : c * cosine + std::sqrt(std::max(0.0, 1.0 - c * c)) * sine;
    }

private:
    static double dot(const std::array<double, 3>& a, const std::array<double, 3>& b) {
        return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
    }
    static double angle(double cosine) { return std::acos(std::clamp(cosine, -1.0, 1.0)); }
};

} // namespace acdf::measure
