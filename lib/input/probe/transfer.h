// From stored numbers to linear radiance.
#pragma once

#include "images/image_file.h"
#include "input/probe/image.h"

namespace acdf::input {

/// Undoes the transfer function that the file declares, or, for integers without a declaration, that of sRGB.
/// Floating point without a declaration is linear. Warns of integers, which are display-referred and end at 1.
void linearize(Image& image, const images::ImageFile& file);

} // namespace acdf::input
