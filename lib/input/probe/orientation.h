// Images that are stored turned or mirrored, as TIFF and Exif number the eight ways.
#pragma once

#include "images/image_file.h"
#include "input/probe/image.h"

namespace acdf::input {

/// 1 (upright) to 8, of the current part of a file: TIFF 6.0, tag 274. Anything else that a file claims is 1, as
/// other readers take it.
int orientation_of(const images::ImageFile& file);

/// Whether the stored rows are columns of the upright image.
bool swaps_sides(int orientation);

/// Turns the pixels of `image`, if there are any, and its sides.
void turn_upright(Image& image, int orientation);

} // namespace acdf::input
