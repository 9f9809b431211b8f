// OpenEXR files, as the program writes them.
#pragma once

#include "images/picture.h"

#include <cstdint>
#include <string>
#include <vector>

namespace acdf::images {

/// The floats of a picture, compressed; `channels` names each. Throws std::runtime_error.
std::vector<std::uint8_t> encode_exr(const Picture& picture, const std::vector<std::string>& channels,
                                     const std::vector<Note>& notes);

} // namespace acdf::images
