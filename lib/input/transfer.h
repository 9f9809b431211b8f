// From stored numbers to linear radiance.
#pragma once

#include "input/image.h"

#include <OpenImageIO/imageio.h>

namespace acdf::input {

/// Undoes the transfer function that `spec` declares, or, for integers without a declaration, that of sRGB.
/// Floating point without a declaration is linear. Warns of integers, which are display-referred and end at 1.
void linearize(Image& image, const OIIO::ImageSpec& spec);

} // namespace acdf::input
