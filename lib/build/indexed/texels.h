// Radiance between the centres of texels, as a renderer looks a map up.
#pragma once

#include "compress/target.h"

#include <acdf/grid.h>

#include <algorithm>
#include <cmath>
#include <cstdint>

namespace acdf::build {

/// The texels of a map of one channel on its own grid. Beyond the sides of an octahedral square, and beyond the
/// first and last row, a lookup meets the texels of the border.
class TexelLookup {
public:
    TexelLookup(const compress::Target& texels, AcdfFilter filter)
        : texels_(texels), bilinear_(filter == ACDF_FILTER_BILINEAR) {}

    /// At a position in texels, [0, columns) x [0, rows).
    double at(double column, double row) const {
        if (!bilinear_) return texel(std::floor(column), std::floor(row));
        const double x = std::floor(column - 0.5), y = std::floor(row - 0.5);
        const double s = column - 0.5 - x, t = row - 0.5 - y;
        return (1.0 - t) * ((1.0 - s) * texel(x, y) + s * texel(x + 1.0, y)) +
               t * ((1.0 - s) * texel(x, y + 1.0) + s * texel(x + 1.0, y + 1.0));
    }

private:
    double texel(double x, double y) const {
        const double columns = texels_.columns;
        if (texels_.parameterization == ACDF_PARAM_OCTAHEDRAL) x = std::clamp(x, 0.0, columns - 1.0);
        else x = x < 0.0 ? x + columns : x >= columns ? x - columns : x;
        const auto row = static_cast<std::uint32_t>(std::clamp(y, 0.0, double(texels_.rows) - 1.0));
        return double{texels_.row(row)[static_cast<std::uint32_t>(x)]};
    }

    const compress::Target& texels_;
    bool bilinear_;
};

/// The direction of a position on a grid.
inline void grid_direction(const compress::Target& grid, double column, double row, float direction[3]) {
    if (grid.parameterization == ACDF_PARAM_OCTAHEDRAL) {
        double d[3];
        acdf_octahedral_direction(column / grid.columns, row / grid.rows, d);
        for (int i = 0; i < 3; ++i) direction[i] = static_cast<float>(d[i]);
        return;
    }
    double sine, cosine, sine_phi, cosine_phi;
    acdf_sincospi(row / grid.rows, &sine, &cosine);
    acdf_sincospi(1.0 - 2.0 * column / grid.columns, &sine_phi, &cosine_phi);
    direction[0] = static_cast<float>(sine * cosine_phi);
    direction[1] = static_cast<float>(sine * sine_phi);
    direction[2] = static_cast<float>(cosine);
}

/// The solid angle of part k of n of a row, over that of a column.
inline double part_of_row(const compress::Target& grid, std::uint32_t row, std::uint32_t k, std::uint32_t n) {
    if (grid.parameterization == ACDF_PARAM_OCTAHEDRAL) return grid.row_measure[row] / n;
    return acdf_row_z(row * n + k, grid.rows * n) - acdf_row_z(row * n + k + 1, grid.rows * n);
}

/// The largest angle, about, that a texel spans from its middle.
inline double texel_reach(const compress::Target& grid) {
    return 1.5 * ACDF_PI / double(std::min(grid.rows, grid.columns));
}

} // namespace acdf::build
