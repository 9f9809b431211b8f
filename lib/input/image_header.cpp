#include "input/image_header.h"

#include <OpenImageIO/imageio.h>

#include <algorithm>

namespace acdf::input {

std::uint64_t image_pixels(const std::string& path) {
    const auto input = OIIO::ImageInput::open(path);
    OIIO::geterror(); // what is wrong is told when the image is read
    if (!input) return 0;
    const OIIO::ImageSpec& spec = input->spec();
    const auto pixels = [](int width, int height) {
        return static_cast<std::uint64_t>(std::max(width, 0)) * static_cast<std::uint64_t>(std::max(height, 0));
    };
    return std::max(pixels(spec.width, spec.height), pixels(spec.full_width, spec.full_height));
}

} // namespace acdf::input
