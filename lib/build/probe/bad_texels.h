// Values of an image that are no radiance.
#pragma once

#include <acdf/builder.h>

#include <array>
#include <string>

namespace acdf::build {

using BadPixels = builder::BadTexelPolicy;
using BadTexels = builder::BadTexels;

using Channels = std::array<float, 3>;

/// The largest half float: larger values are infinite in their files.
constexpr Channels largest_half{65504.0f, 65504.0f, 65504.0f};

/// The largest finite value of each channel, at least 0, of `count` RGB texels.
Channels largest_radiance(const float* rgb, std::size_t count, int threads);

/// Replaces what is NaN, infinite or negative in `rows` rows of `width` RGB texels, of which `first` is the number
/// of the first, and adds to `bad`. BadPixels::clamp needs all rows at once, or the `largest` of all. The same for
/// any number of threads.
void repair_texels(float* rgb, int width, int first, int rows, BadPixels policy, int threads, BadTexels& bad,
                   const Channels* largest = nullptr);

/// "2 NaN, 0 infinite and 1 negative texels, the first at 3,7".
std::string text(const BadTexels& bad);

} // namespace acdf::build
