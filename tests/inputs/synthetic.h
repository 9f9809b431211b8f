// Targets made of a formula, for tests: small, asymmetric in both axes, and the extremes that break fits.
#pragma once

#include "tests/inputs/directions.h"

#include "compress/target.h"

#include <cmath>
#include <cstdint>
#include <functional>
#include <ostream>
#include <random>
#include <string>
#include <vector>

namespace acdf_test {

/// Azimuth of the centre of a column, in (-pi, pi).
inline double centre_phi(std::uint32_t column, std::uint32_t columns) {
    return kPi - 2.0 * kPi * (column + 0.5) / columns;
}

/// z halfway through a row.
inline double centre_z(std::uint32_t row, std::uint32_t rows) {
    return 0.5 * (std::cos(kPi * row / rows) + std::cos(kPi * (row + 1.0) / rows));
}

/// An environment whose texel (column, row) has the value f(column, row).
inline acdf::compress::Target texel_target(std::uint32_t columns, std::uint32_t rows,
                                           const std::function<double(std::uint32_t, std::uint32_t)>& f) {
    std::vector<float> rgb(std::size_t{3} * columns * rows, 0.0f);
    for (std::uint32_t r = 0; r < rows; ++r)
        for (std::uint32_t c = 0; c < columns; ++c)
            rgb[3 * (std::size_t{r} * columns + c)] = static_cast<float>(f(c, r));
    acdf::compress::TargetOptions red;
    red.weights = {1.0, 0.0, 0.0};
    return acdf::compress::environment_target(rgb.data(), columns, rows, red);
}

/// The same with f(phi, z) at the texel's centre.
inline acdf::compress::Target sphere_target(std::uint32_t columns, std::uint32_t rows,
                                            const std::function<double(double, double)>& f) {
    return texel_target(columns, rows, [&](std::uint32_t c, std::uint32_t r) {
        return f(centre_phi(c, columns), centre_z(r, rows));
    });
}

/// The same values on the octahedral square.
inline acdf::compress::Target octahedral(const acdf::compress::Target& target) {
    std::vector<float> rgb(3 * target.values.size(), 0.0f);
    for (std::size_t i = 0; i < target.values.size(); ++i) rgb[3 * i] = target.values[i];
    acdf::compress::TargetOptions red;
    red.weights = {1.0, 0.0, 0.0};
    red.parameterization = ACDF_PARAM_OCTAHEDRAL;
    return acdf::compress::environment_target(rgb.data(), target.columns, target.rows, red);
}

/// Log-normal texels, a share of them dark.
inline acdf::compress::Target noise_target(std::uint32_t columns, std::uint32_t rows, std::uint64_t seed,
                                           double contrast = 1.5, double dark = 0.0) {
    std::mt19937_64 random(seed);
    return texel_target(columns, rows, [&](std::uint32_t, std::uint32_t) {
        const double gauss = // Box and Muller 1958
            std::sqrt(-2.0 * std::log(1.0 - uniform(random))) * std::cos(2.0 * kPi * uniform(random));
        return uniform(random) < dark ? 0.0 : std::exp(contrast * gauss);
    });
}

inline double smooth_sky(double phi, double z) {
    return 1.0 + 0.7 * z + 0.2 * std::cos(phi - 1.0) * std::sqrt(1.0 - z * z) +
           0.05 * std::sin(3.0 * phi + 2.0 * z);
}

struct NamedTarget {
    std::string name;
    acdf::compress::Target target;
};

inline void PrintTo(const NamedTarget& target, std::ostream* out) { *out << target.name; } // for GoogleTest

/// What every fit must survive.
inline std::vector<NamedTarget> synthetic_targets() {
    const auto scaled_sky = [](double scale) {
        return [scale](double phi, double z) { return scale * smooth_sky(phi, z); };
    };
    std::vector<NamedTarget> all;
    all.push_back({"smooth_sky", sphere_target(64, 32, smooth_sky)});
    all.push_back({"peaky_sun", texel_target(96, 48, [](std::uint32_t c, std::uint32_t r) {
                       const double sky = smooth_sky(centre_phi(c, 96), centre_z(r, 48));
                       return c == 29 && r == 11 ? 1e6 * sky : sky;
                   })});
    all.push_back({"one_lit_texel", texel_target(64, 32, [](std::uint32_t c, std::uint32_t r) {
                       return c == 37 && r == 9 ? 3.0 : 0.0;
                   })});
    all.push_back({"black_lower_hemisphere",
                   sphere_target(64, 32, [](double phi, double z) { return z > 0.0 ? smooth_sky(phi, z) : 0.0; })});
    all.push_back({"checkerboard", texel_target(48, 24, [](std::uint32_t c, std::uint32_t r) {
                       return (c + r) % 2 == 0 ? 1.0 : 0.0;
                   })});
    all.push_back({"denormals", sphere_target(40, 20, scaled_sky(1e-41))});
    all.push_back({"huge", sphere_target(40, 20, scaled_sky(1e30))});
    all.push_back({"one_row", sphere_target(64, 1, smooth_sky)});
    all.push_back({"one_column", sphere_target(1, 64, smooth_sky)});
    all.push_back({"one_texel", sphere_target(1, 1, smooth_sky)});
    all.push_back({"odd_noise", noise_target(37, 19, 5, 1.5, 0.3)});
    all.push_back({"constant", sphere_target(50, 25, [](double, double) { return 0.25; })});
    return all;
}

/// The same on the octahedral square.
inline std::vector<NamedTarget> octahedral_targets() {
    std::vector<NamedTarget> all = synthetic_targets();
    for (NamedTarget& target : all) target.target = octahedral(target.target);
    return all;
}

} // namespace acdf_test
