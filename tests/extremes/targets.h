// Probes at the ends of what numbers can hold, and lights where the sphere is awkward.
#pragma once

#include "tests/inputs/synthetic.h"

#include <limits>

namespace acdf_test {

/// A light in one texel (column, row) over a constant rest.
inline acdf::compress::Target lit_texel(std::uint32_t columns, std::uint32_t rows, std::uint32_t column,
                                        std::uint32_t row, double light, double rest) {
    return texel_target(columns, rows,
                        [=](std::uint32_t c, std::uint32_t r) { return c == column && r == row ? light : rest; });
}

/// Texels from 1e-6 to 1e6, any next to any.
inline acdf::compress::Target wide_range(std::uint32_t columns, std::uint32_t rows) {
    std::mt19937_64 random(12);
    return texel_target(columns, rows,
                        [&](std::uint32_t, std::uint32_t) { return std::pow(10.0, 12.0 * uniform(random) - 6.0); });
}

/// Multiples of the smallest positive float.
inline acdf::compress::Target only_denormals(std::uint32_t columns, std::uint32_t rows) {
    std::mt19937_64 random(13);
    return texel_target(columns, rows, [&](std::uint32_t, std::uint32_t) {
        return double{std::numeric_limits<float>::denorm_min()} * std::floor(1000.0 * uniform(random));
    });
}

inline std::vector<NamedTarget> extreme_targets() {
    const auto chequered = [](std::uint32_t c, std::uint32_t r) { return (c + r) % 2 == 0 ? 1e6 : 1.0; };
    std::vector<NamedTarget> all;
    all.push_back({"faint_texel", lit_texel(64, 32, 50, 20, 1e-30, 0.0)});
    all.push_back({"bright_texel", lit_texel(64, 32, 11, 5, 1e30, 0.0)});
    all.push_back({"bright_texel_in_the_dark", lit_texel(64, 32, 11, 5, 1e30, 1e-30)});
    all.push_back({"largest_half", lit_texel(64, 32, 40, 13, 65504.0, 1e-6)});
    all.push_back({"range_of_1e12", wide_range(64, 32)});
    all.push_back({"only_denormals", only_denormals(48, 24)});
    all.push_back({"two_texels", texel_target(2, 1, [](std::uint32_t c, std::uint32_t) { return c + 1.0; })});
    all.push_back({"row_of_noise", noise_target(127, 1, 3)});
    all.push_back({"column_of_noise", noise_target(1, 127, 4)});
    all.push_back({"sun_at_the_pole", lit_texel(96, 48, 17, 0, 1e6, 1.0)});
    all.push_back({"sun_at_the_seam", lit_texel(96, 48, 0, 20, 1e6, 1.0)});
    all.push_back({"sun_before_the_seam", lit_texel(96, 48, 95, 20, 1e6, 1.0)});
    all.push_back({"sun_at_the_horizon", lit_texel(96, 48, 60, 23, 1e6, 1.0)});
    all.push_back({"only_the_nadir", texel_target(96, 48, [](std::uint32_t, std::uint32_t r) { return r == 47; })});
    all.push_back({"chequered", texel_target(48, 24, chequered)});
    return all;
}

/// The same on the octahedral square: what lies at a pole or the seam lies at its folds.
inline std::vector<NamedTarget> octahedral_extremes() {
    std::vector<NamedTarget> all = extreme_targets();
    for (NamedTarget& target : all) {
        target.name += "_octahedral";
        target.target = octahedral(target.target);
    }
    return all;
}

} // namespace acdf_test
