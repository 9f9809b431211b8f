// What environment and local files are measured beside: the full table of all texels of a sky.
#pragma once

#include "compress/target.h"
#include "measure/full_cdf.h"

#include <acdf/sphere.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <random>
#include <vector>

namespace acdf_bench {

/// A sky of smooth clouds, texel noise and a small sun.
inline acdf::compress::Target sky(std::uint32_t columns) {
    const std::uint32_t rows = columns / 2;
    std::vector<float> rgb(std::size_t{columns} * rows * 3);
    std::mt19937 random(1);
    for (std::uint32_t r = 0; r < rows; ++r)
        for (std::uint32_t c = 0; c < columns; ++c) {
            const double x = double(c) / columns, y = double(r) / rows;
            const double clouds = 1.0 + std::sin(17.0 * x + 3.0 * std::sin(11.0 * y)) * std::sin(23.0 * y);
            const bool sun = std::hypot(2.0 * (x - 0.6), y - 0.25) < 0.003;
            const double value =
                sun ? 30000.0 : (y < 0.5 ? 0.3 + clouds : 0.1) * (0.8 + 0.4 * double(random() % 1000) / 1000.0);
            for (std::size_t k = 0; k < 3; ++k)
                rgb[3 * (std::size_t{r} * columns + c) + k] = static_cast<float>(value);
        }
    return acdf::compress::environment_target(rgb.data(), columns, rows, {});
}

/// The full table as pbrt keeps it, in floats from the random numbers to the direction.
struct FullTable {
    acdf::measure::FullCdf cdf;
    std::uint32_t columns, rows;

    explicit FullTable(const acdf::compress::Target& target)
        : cdf(target), columns(target.columns), rows(target.rows) {}
    AcdfDirectionSample sample(float u0, float u1) const {
        const acdf::measure::FullCdf::Draw draw = cdf.sample(u0, u1);
        const auto phi = static_cast<float>(ACDF_PI - draw.column * (2.0 * ACDF_PI / columns));
        const auto theta = static_cast<float>(draw.row * (ACDF_PI / rows));
        const float sine = std::sin(theta);
        return {{sine * std::cos(phi), sine * std::sin(phi), std::cos(theta)}, static_cast<float>(draw.pdf)};
    }
    float pdf(const float w[3]) const {
        const float column =
            static_cast<float>(columns) * (0.5f - std::atan2(w[1], w[0]) * static_cast<float>(0.5 / ACDF_PI));
        const float row = static_cast<float>(rows) * std::acos(w[2]) * static_cast<float>(1.0 / ACDF_PI);
        return static_cast<float>(cdf.pdf(std::min(static_cast<std::uint32_t>(column), columns - 1),
                                          std::min(static_cast<std::uint32_t>(row), rows - 1)));
    }
};

} // namespace acdf_bench
