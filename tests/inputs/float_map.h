// Portable float maps, for programs that need no library to write an image.
#pragma once

#include <fstream>
#include <string>
#include <vector>

namespace acdf::test {

/// Writes height x width x 3 floats, rows from the top, little-endian.
inline void write_float_map(const std::string& path, int width, int height, const std::vector<float>& rgb) {
    std::ofstream file(path, std::ios::binary);
    file << "PF\n" << width << " " << height << "\n-1.0\n";
    const std::streamsize row = std::streamsize{3} * width;
    for (int y = height - 1; y >= 0; --y)
        file.write(reinterpret_cast<const char*>(rgb.data() + y * row), row * std::streamsize{sizeof(float)});
}

} // namespace acdf::test
