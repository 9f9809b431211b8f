// Values of an image that are no radiance.
#pragma once

#include "input/image.h"
#include "input/probe.h"

#include <string>

namespace acdf::input {

/// Replaces what is NaN, infinite or negative, and counts it. Throws Error for BadPixels::error where there is any,
/// naming `path`, how many of each and where the first one is. The same for any number of threads.
BadTexels repair_texels(const std::string& path, Image& image, BadPixels policy, int threads);

} // namespace acdf::input
