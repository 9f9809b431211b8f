// Portable float maps, the plainest of images: read without the module.
#pragma once

#include "images/module.h"

#include <string>

namespace acdf::images {

/// Whether a file is a portable float map as nearly all are: "PF", width and height and "-1" (little-endian
/// numbers, taken as they are) on a line each, RGB, and as many bytes as that makes. Of any other file OpenImageIO
/// tells what it is, or what is wrong with it.
bool is_float_map(const std::string& path);

/// Reads those.
const ImageReader& float_map_reader();

} // namespace acdf::images
