// Portable network graphics, as the program writes them.
#pragma once

#include "images/picture.h"

#include <cstdint>
#include <vector>

namespace acdf::images {

/// RGB as displayed (sRGB, [0, 1]; what lies outside is clamped, NaN is 0), rounded to 8 bits. Throws
/// std::bad_alloc. After ISO/IEC 15948.
std::vector<std::uint8_t> encode_png(const Picture& rgb, const std::vector<Note>& notes);

} // namespace acdf::images
