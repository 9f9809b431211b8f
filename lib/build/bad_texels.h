// Values of an image that are no radiance.
#pragma once

#include <cstdint>

namespace acdf::build {

/// What becomes of values that are no radiance: NaN, infinite, negative. None of them ever reaches a CDF.
enum class BadPixels {
    zero,  ///< all are 0
    clamp, ///< +infinity is the largest finite value of its channel; the others are 0
    error, ///< an image that has any is refused
};

/// Texels with channels that are no radiance, each counted once, as the first of nan, infinite, negative that it
/// has. `x`, `y`: the first in the source, row by row from the top.
struct BadTexels {
    std::uint64_t nan = 0, infinite = 0, negative = 0;
    int x = -1, y = -1;

    std::uint64_t count() const { return nan + infinite + negative; }
};

/// Replaces what is NaN, infinite or negative in `rows` rows of `width` RGB texels, of which `first` is the number
/// of the first, and adds to `bad`. BadPixels::clamp needs all rows at once. The same for any number of threads.
void repair_texels(float* rgb, int width, int first, int rows, BadPixels policy, int threads, BadTexels& bad);

} // namespace acdf::build
