// Pixels in memory.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

namespace acdf::images {

/// Floats, row by row from the top left.
struct Picture {
    int width = 0, height = 0, channels = 3;
    std::vector<float> values; ///< height x width x channels

    Picture() = default;
    /// Black.
    Picture(int w, int h, int c = 3) : width(w), height(h), channels(c) { values.resize(index(0, h)); }

    float* at(int x, int y) { return values.data() + index(x, y); }
    const float* at(int x, int y) const { return values.data() + index(x, y); }

private:
    std::size_t index(int x, int y) const {
        return (static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x)) *
               static_cast<std::size_t>(channels);
    }
};

/// What an image file says of itself: a text in UTF-8 by a keyword in ASCII, of which "Description" and "Software"
/// are known to every format.
struct Note {
    std::string name, text;
};

} // namespace acdf::images
