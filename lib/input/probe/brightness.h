// How bright texels are: all that the detection of layouts looks at.
#pragma once

#include "input/probe/image.h"

#include <cstddef>
#include <vector>

namespace acdf::input {

/// The largest channel of each texel.
class Brightness {
public:
    Brightness(int width, int height)
        : width_(width), height_(height),
          values_(static_cast<std::size_t>(width) * static_cast<std::size_t>(height)) {}
    explicit Brightness(const Image& image);

    int width() const { return width_; }
    int height() const { return height_; }
    float at(int x, int y) const { return values_[index(x, y)]; }
    void set_row(int y, const float* rgb);

    /// Black: a thousandth of what is typical, for lossy compression.
    double black_level() const;

private:
    std::size_t index(int x, int y) const {
        return static_cast<std::size_t>(y) * static_cast<std::size_t>(width_) + static_cast<std::size_t>(x);
    }

    int width_, height_;
    std::vector<float> values_;
};

} // namespace acdf::input
