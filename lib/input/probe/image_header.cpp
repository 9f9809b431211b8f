#include "input/probe/image_header.h"

#include "images/image_file.h"
#include "input/probe/orientation.h"
#include "input/probe/source.h"

#include <algorithm>

namespace acdf::input {

ImageSize image_size(const std::string& source) {
    const std::vector<std::string> paths = probe_files(source);
    if (paths.size() > 1) { // a cross
        const ImageSize face = image_size(paths[0]);
        return {4 * face.width, 3 * face.height};
    }
    const images::ImageFile file(source);
    if (!file.is_open()) return {}; // errors are reported when the image is read
    const auto size = [](const images::Window& window) {
        return ImageSize{std::max(window.width, 0), std::max(window.height, 0)};
    };
    const ImageSize data = size(file.header().data), display = size(file.header().display);
    const ImageSize stored = data.pixels() > display.pixels() ? data : display;
    return swaps_sides(orientation_of(file)) ? ImageSize{stored.height, stored.width} : stored;
}

} // namespace acdf::input
