// What the tests of samplers of irradiance share: targets, normals, and the same quantities by brute force.
#pragma once

#include "tests/inputs/synthetic.h"
#include "tests/lib/compress/chi_square.h"
#include "tests/lib/measure/samplers/square_texels.h"

#include <acdf/sample.h>

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <vector>

namespace acdf_test {

inline std::vector<Normal> random_normals(int count, std::uint64_t seed) {
    std::mt19937_64 random(seed);
    std::vector<Normal> out;
    for (int i = 0; i < count; ++i) out.push_back(random_direction(random));
    return out;
}

/// Axes, a seam, and some of no symmetry.
inline std::vector<Normal> awkward_normals() {
    std::vector<Normal> out = random_normals(4, 99);
    for (const Normal n : {Normal{0, 0, 1}, Normal{0, 0, -1}, Normal{1, 0, 0}, Normal{-1, 0, 0}, Normal{0, 1, 0}})
        out.push_back(n);
    return out;
}

/// Skies with and without a sun, noise and darkness, of moderate integral.
inline std::vector<NamedTarget> irradiance_targets() {
    std::vector<NamedTarget> all;
    for (NamedTarget& t : synthetic_targets())
        if (t.name != "denormals" && t.name != "huge") all.push_back(std::move(t));
    all.push_back({"square_noise", octahedral(noise_target(36, 36, 8, 1.0, 0.2))});
    return all;
}
/// Those whose texels are small enough to be taken at their centres.
inline std::vector<NamedTarget> fine_targets() {
    std::vector<NamedTarget> all;
    for (NamedTarget& t : irradiance_targets())
        if (t.target.rows >= 16 && t.target.columns >= 16) all.push_back(std::move(t));
    return all;
}

inline bool is_square(const acdf::compress::Target& t) { return t.parameterization == ACDF_PARAM_OCTAHEDRAL; }

/// The texel of a direction, by atan2 and acos; on the square by Clarberg's map.
inline std::size_t texel_of(const acdf::compress::Target& t, const float* d) {
    if (is_square(t)) return square_texel(t.columns, t.rows, d);
    const double length = std::sqrt(dot(d, d));
    const auto c = static_cast<int>(t.columns * (0.5 - std::atan2(d[1], d[0]) / (2.0 * kPi)));
    const auto r = static_cast<int>(t.rows * std::acos(d[2] / length) / kPi);
    return static_cast<std::size_t>(std::min<int>(r, static_cast<int>(t.rows) - 1)) * t.columns +
           static_cast<std::size_t>(std::min<int>(c, static_cast<int>(t.columns) - 1));
}

/// Calls visit(texel, direction, solid angle) for points x points directions of each texel, evenly in phi and z or
/// in u and v.
template <class Visit>
void for_each_direction(const acdf::compress::Target& t, std::uint32_t points, const Visit& visit) {
    if (is_square(t)) return for_each_square_direction(t.columns, t.rows, points, visit);
    std::vector<double> cosine, sine; // of azimuths
    for (std::uint32_t i = 0; i < t.columns * points; ++i) {
        const double phi = kPi - 2.0 * kPi * (i + 0.5) / (double(t.columns) * points);
        cosine.push_back(std::cos(phi));
        sine.push_back(std::sin(phi));
    }
    for (std::uint32_t r = 0; r < t.rows; ++r) {
        const double top = std::cos(kPi * r / t.rows), foot = std::cos(kPi * (r + 1.0) / t.rows);
        const double omega = (top - foot) * 2.0 * kPi / t.columns / (double(points) * points);
        for (std::uint32_t i = 0; i < points; ++i) {
            const double z = top + (foot - top) * (i + 0.5) / points, s = std::sqrt((1.0 - z) * (1.0 + z));
            for (std::uint32_t j = 0; j < t.columns * points; ++j) {
                const double d[3] = {s * cosine[j], s * sine[j], z};
                visit(std::size_t{r} * t.columns + j / points, d, omega);
            }
        }
    }
}

/// Means of f/p and of its square, with standard errors.
struct MonteCarlo {
    double mean = 0.0, mean_error = 0.0;
    double second = 0.0, second_error = 0.0;
};

/// `estimate()` is one f/p.
template <class Estimate>
MonteCarlo monte_carlo(int samples, const Estimate& estimate) {
    double sum[4] = {0.0, 0.0, 0.0, 0.0};
    for (int i = 0; i < samples; ++i) {
        const double x = estimate();
        double power = 1.0;
        for (double& s : sum) s += power *= x;
    }
    for (double& s : sum) s /= samples;
    return {sum[0], std::sqrt(std::max(sum[1] - sum[0] * sum[0], 0.0) / samples), sum[1],
            std::sqrt(std::max(sum[3] - sum[1] * sum[1], 0.0) / samples)};
}

/// E(n) with the true cosines.
inline double irradiance(const acdf::compress::Target& t, const Normal& n) {
    double sum = 0.0;
    for_each_direction(t, 8, [&](std::size_t i, const double* d, double omega) {
        const double cosine = n[0] * d[0] + n[1] * d[1] + n[2] * d[2];
        if (cosine > 0.0) sum += t.values[i] * cosine * omega;
    });
    return sum;
}

} // namespace acdf_test
