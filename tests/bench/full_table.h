// What environment and local files are measured beside: the full table of all texels of a sky.
#pragma once

#include "compress/target.h"
#include "measure/samplers/full_cdf.h"

#include <acdf/grid.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <random>
#include <vector>

namespace acdf_bench {

/// A sky of smooth clouds, texel noise and a small sun: columns x columns / 2 texels by azimuth and elevation, or
/// the octahedral square of columns x columns, as pbrt-v4 has it.
inline acdf::compress::Target sky(std::uint32_t columns, bool octahedral = false) {
    const std::uint32_t rows = octahedral ? columns : columns / 2;
    std::vector<float> rgb(std::size_t{columns} * rows * 3);
    std::mt19937 random(1);
    for (std::uint32_t r = 0; r < rows; ++r)
        for (std::uint32_t c = 0; c < columns; ++c) {
            double x = double(c) / columns, y = double(r) / rows;
            if (octahedral) {
                double d[3];
                acdf_octahedral_direction((c + 0.5) / columns, (r + 0.5) / rows, d);
                x = 0.5 - std::atan2(d[1], d[0]) * (0.5 / ACDF_PI);
                y = std::acos(d[2]) / ACDF_PI;
            }
            const double clouds = 1.0 + std::sin(17.0 * x + 3.0 * std::sin(11.0 * y)) * std::sin(23.0 * y);
            const bool sun = std::hypot(2.0 * (x - 0.6), y - 0.25) < 0.003;
            const double value =
                sun ? 30000.0 : (y < 0.5 ? 0.3 + clouds : 0.1) * (0.8 + 0.4 * double(random() % 1000) / 1000.0);
            for (std::size_t k = 0; k < 3; ++k)
                rgb[3 * (std::size_t{r} * columns + c) + k] = static_cast<float>(value);
        }
    acdf::compress::TargetOptions options;
    if (octahedral) options.parameterization = ACDF_PARAM_OCTAHEDRAL;
    return acdf::compress::environment_target(rgb.data(), columns, rows, options);
}

/// The full table as pbrt keeps it, in floats from the random numbers to the direction, on either grid.
struct FullTable {
    acdf::measure::FullCdf cdf;
    std::uint32_t columns, rows;
    bool octahedral;

    explicit FullTable(const acdf::compress::Target& target)
        : cdf(target), columns(target.columns), rows(target.rows),
          octahedral(target.parameterization == ACDF_PARAM_OCTAHEDRAL) {}
    AcdfDirectionSample sample(float u0, float u1) const {
        const acdf::measure::FullCdf::Draw draw = cdf.sample(u0, u1);
        if (octahedral)
            return square_direction(static_cast<float>(draw.column) / static_cast<float>(columns),
                                    static_cast<float>(draw.row) / static_cast<float>(rows),
                                    static_cast<float>(draw.pdf));
        const auto phi = static_cast<float>(ACDF_PI - draw.column * (2.0 * ACDF_PI / columns));
        const auto theta = static_cast<float>(draw.row * (ACDF_PI / rows));
        const float sine = std::sin(theta);
        return {{sine * std::cos(phi), sine * std::sin(phi), std::cos(theta)}, static_cast<float>(draw.pdf)};
    }
    float pdf(const float w[3]) const {
        if (octahedral) return square_pdf(w);
        const float column =
            static_cast<float>(columns) * (0.5f - std::atan2(w[1], w[0]) * static_cast<float>(0.5 / ACDF_PI));
        const float row = static_cast<float>(rows) * std::acos(w[2]) * static_cast<float>(1.0 / ACDF_PI);
        return static_cast<float>(cdf.pdf(std::min(static_cast<std::uint32_t>(column), columns - 1),
                                          std::min(static_cast<std::uint32_t>(row), rows - 1)));
    }

private:
    // The equal-area map in floats, by the functions of the library (Clarberg 2008).
    static AcdfDirectionSample square_direction(float across, float along, float pdf) {
        const float u = 1.0f - 2.0f * across, v = 2.0f * along - 1.0f, a = std::fabs(u), b = std::fabs(v);
        const float signed_distance = 1.0f - (a + b), r = 1.0f - std::fabs(signed_distance);
        const float phi = (r == 0.0f ? 1.0f : (b - a) / r + 1.0f) * static_cast<float>(ACDF_PI / 4.0);
        const float sine = r * std::sqrt(std::max(0.0f, 2.0f - r * r));
        return {{std::copysign(std::cos(phi), u) * sine, std::copysign(std::sin(phi), v) * sine,
                 std::copysign(1.0f - r * r, signed_distance)},
                pdf};
    }
    float square_pdf(const float w[3]) const {
        const float x = std::fabs(w[0]), y = std::fabs(w[1]), r = std::sqrt(std::max(0.0f, 1.0f - std::fabs(w[2])));
        const float along = std::atan2(y, x) * static_cast<float>(2.0 / ACDF_PI) * r, across = r - along;
        const float a = w[2] < 0.0f ? 1.0f - along : across, b = w[2] < 0.0f ? 1.0f - across : along;
        const float column = static_cast<float>(columns) * 0.5f * (1.0f - std::copysign(a, w[0]));
        const float row = static_cast<float>(rows) * 0.5f * (1.0f + std::copysign(b, w[1]));
        return static_cast<float>(cdf.pdf(std::min(static_cast<std::uint32_t>(column), columns - 1),
                                          std::min(static_cast<std::uint32_t>(row), rows - 1)));
    }
};

} // namespace acdf_bench
