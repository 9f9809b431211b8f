// The light of a probe as a few ten thousand points.
#pragma once

#include "compress/target.h"

#include <array>
#include <vector>

namespace acdf::compress {

using Direction = std::array<double, 3>;

inline double dot(const Direction& a, const Direction& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }

/// Light from so small a solid angle that it has one cosine.
struct LightPoint {
    Direction direction{};
    double amount = 0.0;
    double measure = 0.0; ///< the solid angle that it comes from
};

/// The direction at a place of the grid, in texels.
Direction direction_at(const Target& target, double row, double column);

/// The integrals of g over blocks of about a degree.
std::vector<LightPoint> light_points(const Target& target);

} // namespace acdf::compress
