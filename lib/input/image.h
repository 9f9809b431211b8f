// The pixels of an image file, before anything is known of its projection.
#pragma once

#include "input/probe.h"

#include <string>
#include <vector>

namespace acdf::input {

/// What the file says it is: OpenEXR's envmap attribute, or the texture format of maketx.
enum class EnvironmentTag { none, latlong, cube };

/// RGB of the display window, row-major from the top left. Linear, as stored otherwise: no exposure, no
/// change of primaries, bad texels included.
struct Image {
    int width = 0, height = 0;
    std::vector<float> rgb; ///< height x width x 3
    EnvironmentTag tag = EnvironmentTag::none;
    std::vector<std::string> warnings;
};

/// Reads the first part, at full resolution. `threads` as in ProbeOptions. Throws Error.
Image read_image(const std::string& path, int threads);

/// SHA-256 of the file's bytes, 64 hex digits. Throws Error.
std::string file_sha256(const std::string& path);

/// "path: what", newlines flattened.
Error input_error(const std::string& path, const std::string& what);

} // namespace acdf::input
