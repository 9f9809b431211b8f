// What an image says of itself before any pixel is read.
#pragma once

#include <cstdint>
#include <string>

namespace acdf::input {

struct ImageSize {
    int width = 0, height = 0;
    std::uint64_t pixels() const { return static_cast<std::uint64_t>(width) * static_cast<std::uint64_t>(height); }
};

/// That of the image's display window or of its data window, whichever has more pixels, turned upright; 0 x 0 where
/// its header cannot be read. Of six faces, that of the cross that they make.
ImageSize image_size(const std::string& source);

} // namespace acdf::input
