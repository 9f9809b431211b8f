// Boxes of the octahedral square on the sphere: what tiles, bright tiles and horizons of local maps ask of a box.
#pragma once

#include "compress/fit/partition.h"
#include "compress/target.h"

#include <array>

namespace acdf::compress {

/// Whether a target lies on the octahedral square: rows are v and columns u; else they are theta and phi.
inline bool is_octahedral(const Target& target) { return target.parameterization == ACDF_PARAM_OCTAHEDRAL; }

/// The unit direction at a position in texels of a target on the square.
std::array<double, 3> octahedral_direction(const Target& target, double column, double row);

/// A cosine that no direction of a box exceeds with the unit vector `n`, and that is near the largest: 1 inside,
/// else that at its border, from points an eighth of a side apart and what may lie between them.
double largest_octahedral_cosine(const Target& target, const Box& box, const std::array<double, 3>& n);

} // namespace acdf::compress
