#include "input/probe/orientation.h"

#include <algorithm>
#include <utility>

namespace acdf::input {
namespace {

constexpr int kUpright = 1, kLast = 8;

std::size_t texel(int width, int x, int y) {
    return 3 * (static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x));
}

/// Which side of the upright image the first stored row and the first stored column are.
bool first_row_is_at_the_far_side(int orientation) {
    return orientation == 3 || orientation == 4 || orientation == 6 || orientation == 7;
}
bool first_column_is_at_the_far_side(int orientation) {
    return orientation == 2 || orientation == 3 || orientation == 7 || orientation == 8;
}

} // namespace

int orientation_of(const images::ImageFile& file) {
    const int stored = file.integer("Orientation", kUpright);
    return stored >= kUpright && stored <= kLast ? stored : kUpright;
}

bool swaps_sides(int orientation) { return orientation >= 5; }

void turn_upright(Image& image, int orientation) {
    if (orientation == kUpright) return;
    const int width = image.width, height = image.height; // as stored
    const bool swapped = swaps_sides(orientation);
    if (swapped) std::swap(image.width, image.height);
    if (image.rgb.empty()) return;
    std::vector<float> upright(image.rgb.size());
    for (int row = 0; row < height; ++row)
        for (int column = 0; column < width; ++column) {
            int x = first_column_is_at_the_far_side(orientation) ? width - 1 - column : column;
            int y = first_row_is_at_the_far_side(orientation) ? height - 1 - row : row;
            if (swapped) std::swap(x, y);
            std::copy_n(image.rgb.data() + texel(width, column, row), 3, upright.data() + texel(image.width, x, y));
        }
    image.rgb = std::move(upright);
}

} // namespace acdf::input
