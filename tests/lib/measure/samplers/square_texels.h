// Texels of the octahedral square, for tests: which holds a direction, and directions all over each.
#pragma once

#include <acdf/octahedral.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>

namespace acdf_test {

/// Row by row from v = 0.
inline std::size_t square_texel(std::uint32_t columns, std::uint32_t rows, const float* d) {
    const double w[3] = {d[0], d[1], d[2]};
    double u, v;
    acdf_octahedral_point(w, &u, &v);
    return std::size_t{std::min(static_cast<std::uint32_t>(v * rows), rows - 1)} * columns +
           std::min(static_cast<std::uint32_t>(u * columns), columns - 1);
}

/// Calls visit(texel, direction, solid angle) for points x points directions of each texel, evenly in u and v.
template <class Visit>
void for_each_square_direction(std::uint32_t columns, std::uint32_t rows, std::uint32_t points,
                               const Visit& visit) {
    const double side = points, omega = 4.0 * ACDF_PI / (side * side * columns * rows);
    for (std::uint32_t i = 0; i < rows * points; ++i)
        for (std::uint32_t j = 0; j < columns * points; ++j) {
            double d[3];
            acdf_octahedral_direction((j + 0.5) / (side * columns), (i + 0.5) / (side * rows), d);
            visit(std::size_t{i / points} * columns + j / points, d, omega);
        }
}

} // namespace acdf_test
