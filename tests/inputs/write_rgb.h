// Image files of known pixels, for the tests.
#pragma once

#include "tests/inputs/float_map.h"

#include "images/image_file.h"

#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

namespace acdf::test {

/// Writes height x width x 3 floats, rows from the top. Formats but .pfm need the module, which takes long to load.
inline void write_rgb(const std::string& path, int width, int height, const std::vector<float>& rgb) {
    if (std::filesystem::path(path).extension() == ".pfm") return write_float_map(path, width, height, rgb);
    images::Picture picture(width, height);
    picture.values = rgb;
    const std::vector<std::uint8_t> bytes = images::encode(picture, {path, false, {}, {}});
    std::ofstream(path, std::ios::binary)
        .write(reinterpret_cast<const char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
}

} // namespace acdf::test
