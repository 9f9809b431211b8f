// Photographs whose highlights are in a second image.
#pragma once

#include <string>

namespace acdf::input {

/// Whether a file is a JPEG that carries a gain map: Ultra HDR (Android, Adobe), ISO 21496-1, or Apple's.
bool has_gain_map(const std::string& path);

} // namespace acdf::input
