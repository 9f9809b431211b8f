#include "input/probe/image_header.h"

#include "images/image_file.h"
#include "input/probe/orientation.h"

#include <algorithm>

namespace acdf::input {

ImageSize image_size(const std::string& path) {
    const images::ImageFile file(path);
    if (!file.is_open()) return {}; // what is wrong is told when the image is read
    const auto size = [](const images::Window& window) {
        return ImageSize{std::max(window.width, 0), std::max(window.height, 0)};
    };
    const ImageSize data = size(file.header().data), display = size(file.header().display);
    const ImageSize stored = data.pixels() > display.pixels() ? data : display;
    return swaps_sides(orientation_of(file)) ? ImageSize{stored.height, stored.width} : stored;
}

} // namespace acdf::input
