// What an image says of itself before any pixel is read.
#pragma once

#include <cstdint>
#include <string>

namespace acdf::input {

/// Pixels of the image, those of its display window or its data window, whichever has more; 0 where its header
/// cannot be read.
std::uint64_t image_pixels(const std::string& path);

} // namespace acdf::input
