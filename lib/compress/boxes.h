// Boxes of texels on the sphere.
#pragma once

#include "compress/target.h"

#include <array>
#include <cstddef>
#include <cstdint>

namespace acdf::compress {

/// Rows [begin[0], end[0]) and columns [begin[1], end[1]) of a target.
struct Box {
    std::array<std::uint32_t, 2> begin{}, end{};

    std::uint32_t length(std::size_t axis) const { return end[axis] - begin[axis]; }
};

/// Whether a target lies on the octahedral square: rows are v and columns u; else they are theta and phi.
inline bool is_octahedral(const Target& target) { return target.parameterization == ACDF_PARAM_OCTAHEDRAL; }

/// The unit direction at a position in texels of a target on the square.
std::array<double, 3> octahedral_direction(const Target& target, double column, double row);

/// The middle of a box in phi and z, or in u and v, and so of its solid angle.
std::array<double, 3> centre(const Target& target, const Box& box);

/// The largest distance of any point of a box on the unit sphere from its centre; on the octahedral square a bound.
double radius(const Target& target, const Box& box);

} // namespace acdf::compress
