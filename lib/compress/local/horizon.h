// What a normal sees of boxes that its horizon cuts.
#pragma once

#include "compress/local/light.h"
#include "compress/target.h"

namespace acdf::compress {

/// Rounding of normals and directions to float must not take light over the horizon that was not expected.
constexpr double kHorizonMargin = 1e-4;

/// The root of the mean over a box of max(0, n . omega)^2, about, whatever the size of texels. Positive wherever
/// anything of it is above the horizon.
double mean_cosine(const Target& target, const Box& box, const Direction& normal);

} // namespace acdf::compress
