// Pictures as the bytes of OpenEXR files.
#pragma once

#include "images/module.h"

namespace acdf::images {

/// images/module.h: OpenExrModule::encode.
bool encode_openexr(const Picture& picture, const std::vector<std::string>& channels,
                    const std::vector<Note>& notes, std::vector<std::uint8_t>& bytes, std::string& error);

} // namespace acdf::images
