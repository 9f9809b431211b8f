// Values of an image that are no radiance.
#pragma once

#include "input/probe.h"

#include <string>

namespace acdf::input {

/// Replaces what is NaN, infinite or negative in `rows` rows of `width` RGB texels, of which `first` is the number
/// of the first, and adds to `bad`. BadPixels::clamp needs all rows at once. The same for any number of threads.
void repair_texels(float* rgb, int width, int first, int rows, BadPixels policy, int threads, BadTexels& bad);

/// Throws Error where there are any: how many of each and where the first one is.
void refuse_bad_texels(const std::string& path, const BadTexels& bad);

} // namespace acdf::input
