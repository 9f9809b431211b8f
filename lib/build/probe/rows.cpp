#include "build/probe/rows.h"

#include "build/probe/resample.h"

#include <algorithm>
#include <limits>
#include <utility>

namespace acdf::build {

void RepairedRows::begin(int width, int height) {
    width_ = width;
    height_ = height;
    rows_.begin(width, height);
}

void RepairedRows::take(int first, int count, float* rgb, const Channels* largest) {
    repair_texels(rgb, width_, first, count, options_.bad_pixels, options_.threads, bad_, largest);
    pass_on(first, count, rgb);
}

void RepairedRows::repair_whole(int width, int height, float* rgb, const Channels* largest) {
    repair_texels(rgb, width, 0, height, options_.bad_pixels, options_.threads, bad_, largest);
}

void RepairedRows::take_whole(const Map& map, std::vector<float> rgb) {
    const bool latlong = map.layout == Layout::latlong;
    if (!latlong && pass_on(map, rgb)) return;
    begin(latlong_width(map), latlong ? map.height : latlong_width(map) / 2);
    if (!latlong) rgb = resample_to_latlong(map, std::move(rgb), width_, options_.threads);
    pass_on(0, height_, rgb.data());
}

/// False where it is wanted as rows.
bool RepairedRows::pass_on(const Map& map, const std::vector<float>& rgb) {
    width_ = map.width;
    height_ = map.height;
    const bool black = std::all_of(rgb.begin(), rgb.end(), [](float v) { return v == 0.0f; });
    if (!black || !options_.uniform_if_black) return rows_.take_map(map, rgb);
    lit_ = rows_.take_map(map, std::vector<float>(rgb.size(), std::numeric_limits<float>::min()));
    return lit_;
}

void RepairedRows::pass_on(int first, int count, const float* rgb) {
    has_rows_ = true;
    if (black_) {
        const std::size_t values =
            std::size_t{3} * static_cast<std::size_t>(width_) * static_cast<std::size_t>(count);
        black_ = std::all_of(rgb, rgb + values, [](float v) { return v == 0.0f; });
    }
    rows_.take(first, count, rgb);
}

// The smallest normal number: 0 for all that light is used for, but for its pdf.
bool RepairedRows::light_if_black() {
    if (!has_rows_ || !black_ || !options_.uniform_if_black) return lit_;
    const std::vector<float> row(std::size_t{3} * static_cast<std::size_t>(width_),
                                 std::numeric_limits<float>::min());
    for (int y = 0; y < height_; ++y) rows_.take(y, 1, row.data());
    return true;
}

} // namespace acdf::build
