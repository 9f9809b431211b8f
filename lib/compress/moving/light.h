// Texels of a frame as light.
#pragma once

#include "compress/moving/sums.h"

#include <cstddef>
#include <cstdint>

namespace acdf::compress {

/// Takes RGB texels [x, x + count) of a row, at most kTexelsAtOnce, into `sums`. NaN, infinite and negative values
/// become 0; true where there were any, and `bad[i]` is then 1, 2 or 3, else 0.
constexpr std::size_t kTexelsAtOnce = 256;
bool take_light(const float* rgb, std::uint32_t x, std::uint32_t r, std::size_t count, const TargetOptions& options,
                MovingSums& sums, std::uint8_t* bad);

} // namespace acdf::compress
