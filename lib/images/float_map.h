// Portable float maps, the plainest of images: read without the module.
#pragma once

#include "images/module.h"

namespace acdf::images {

/// Reads portable float maps as nearly all are: "PF", width and height and "-1" (little-endian numbers, taken as
/// they are) on a line each, RGB, and as many bytes as that makes. It opens no other file, and does not say why:
/// OpenImageIO tells what that is, or what is wrong with it.
const ImageReader& float_map_reader();

} // namespace acdf::images
