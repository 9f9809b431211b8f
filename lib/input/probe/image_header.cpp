#include "input/probe/image_header.h"

#include "images/image_file.h"

#include <algorithm>

namespace acdf::input {

std::uint64_t image_pixels(const std::string& path) {
    const images::ImageFile file(path);
    if (!file.is_open()) return 0; // what is wrong is told when the image is read
    const auto pixels = [](int width, int height) {
        return static_cast<std::uint64_t>(std::max(width, 0)) * static_cast<std::uint64_t>(std::max(height, 0));
    };
    const images::Window &data = file.header().data, &display = file.header().display;
    return std::max(pixels(data.width, data.height), pixels(display.width, display.height));
}

} // namespace acdf::input
