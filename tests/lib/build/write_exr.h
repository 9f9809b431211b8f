// Probes as image files, for tests that compare with the program.
#pragma once

#include "images/image_file.h"

#include <fstream>
#include <string>
#include <vector>

namespace acdf::test {

/// RGB floats, rows from the top.
inline void write_exr(const std::string& path, const std::vector<float>& rgb, int width, int height) {
    images::Picture picture(width, height);
    picture.values = rgb;
    const std::vector<std::uint8_t> bytes = images::encode(picture, {path, false, {}, {}});
    std::ofstream(path, std::ios::binary)
        .write(reinterpret_cast<const char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
}

} // namespace acdf::test
