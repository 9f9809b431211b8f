// Portable float maps, the plainest of images: read without a library.
#pragma once

#include "images/module.h"

namespace acdf::images {

/// Of regular files. Reads portable float maps: "PF" (RGB), "Pf" (grey) or "PF4" (RGBA, which OpenImageIO does not
/// know), width, height and scale, and as many bytes as that makes. Numbers are little-endian where the scale is
/// negative, and are multiplied with its absolute value. It opens no other file, and does not say why: OpenImageIO
/// reports the format, or the error.
const ImageReader& float_map_reader();

} // namespace acdf::images
