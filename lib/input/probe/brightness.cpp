#include "input/probe/brightness.h"

#include <algorithm>
#include <cmath>

namespace acdf::input {

Brightness::Brightness(const Image& image) : Brightness(image.width, image.height) {
    for (int y = 0; y < height_; ++y) set_row(y, image.rgb.data() + 3 * index(0, y));
}

void Brightness::set_row(int y, const float* rgb) {
    for (int x = 0; x < width_; ++x, rgb += 3) values_[index(x, y)] = std::max({rgb[0], rgb[1], rgb[2]});
}

// Roots, so that a sun does not set the level.
double Brightness::black_level() const {
    double sum = 0.0;
    for (int y = 0; y < height_; ++y) {
        double row = 0.0;
        for (int x = 0; x < width_; ++x) row += std::sqrt(static_cast<double>(at(x, y)));
        sum += row / width_;
    }
    const double root = sum / height_;
    return 1e-3 * root * root;
}

} // namespace acdf::input
