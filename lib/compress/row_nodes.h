// Quadrature over a row of texels of an environment map.
#pragma once

#include <array>
#include <cstdint>

namespace acdf::compress {

/// Height in texels from the row's upper edge, and share of the solid angle.
struct RowNode {
    double height, weight;
};

/// Three Gauss-Legendre points in each half of a row, where interpolation between rows is smooth.
std::array<RowNode, 6> row_nodes(bool octahedral, std::uint32_t rows, std::uint32_t row);

} // namespace acdf::compress
