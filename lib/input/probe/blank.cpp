#include "input/probe/blank.h"

#include "build/probe/cube.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

namespace acdf::input {
namespace {

// A credit line may stand in the unused part, so nine tenths will do; more than half of what is used must show
// something, or what is blank proves nothing.
constexpr double mostly = 0.9, hardly = 0.5;

/// Calls visit(x, y) for all texels.
template <typename Visit>
void for_each_texel(const Brightness& image, Visit&& visit) {
    for (int y = 0; y < image.height(); ++y)
        for (int x = 0; x < image.width(); ++x) visit(x, y);
}

/// Share of the texels with is(x, y) among those that `select` picks; 0 where it picks none.
template <typename Select, typename Is>
double share(const Brightness& image, Select&& select, Is&& is) {
    std::uint64_t found = 0, all = 0;
    for_each_texel(image, [&](int x, int y) {
        if (!select(x, y)) return;
        ++all;
        found += is(x, y);
    });
    return all ? static_cast<double>(found) / static_cast<double>(all) : 0.0;
}

/// The middle one of the values that `select` picks; 0 where it picks none.
template <typename Select>
double median(const Brightness& image, Select&& select) {
    std::vector<float> values;
    for_each_texel(image, [&](int x, int y) {
        if (select(x, y)) values.push_back(image.at(x, y));
    });
    if (values.empty()) return 0.0;
    const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
    std::nth_element(values.begin(), middle, values.end());
    return static_cast<double>(*middle);
}

/// Whether `count` discs beside each other, whose radius is `size` halves of the height, have one value around them
/// but not along their rims. `discs.width()` may be that of a picture of fewer rows.
bool has_discs(const Brightness& image, int count, double size) {
    const double across = static_cast<double>(count) / image.width();
    const double texel = 2.0 * std::max(across, 1.0 / image.height());
    const auto radius = [&](int x, int y) {
        const double u = (x + 0.5) * across;
        return std::hypot(2.0 * (u - std::floor(u)) - 1.0, (2.0 * y + 1.0) / image.height() - 1.0);
    };
    const auto around = [&](int x, int y) { return radius(x, y) > size + texel; };
    const auto beside = [&](int x, int y) { return around(x, y) && radius(x, y) < 1.1 * size + texel; };
    const auto rim = [&](int x, int y) {
        const double r = radius(x, y);
        return r < size - texel && r > 0.9 * size;
    };
    const double blank = median(image, around), tolerance = image.black_level() + 0.02 * blank;
    const auto is_blank = [&](int x, int y) {
        return std::abs(static_cast<double>(image.at(x, y)) - blank) <= tolerance;
    };
    return share(image, around, is_blank) >= mostly && share(image, beside, is_blank) >= mostly &&
           share(image, rim, is_blank) <= hardly;
}

} // namespace

bool is_cross(const Brightness& image, build::Layout layout) {
    const build::Map map{layout, image.width(), image.height()};
    const double level = image.black_level();
    const auto black = [&](int x, int y) { return static_cast<double>(image.at(x, y)) <= level; };
    const auto on_face = [&](int x, int y) { return on_cube_face(map, x, y); };
    const auto beside = [&](int x, int y) { return !on_cube_face(map, x, y); };
    return share(image, beside, black) >= mostly && share(image, on_face, black) <= hardly;
}

bool is_disc(const Brightness& image) { return has_discs(image, 1, 1.0); }

bool is_pair_of_discs(const Brightness& image) {
    for (const double size : {1.0, 0.95, 0.9, 0.85, 0.8}) // cameras leave a margin
        if (has_discs(image, 2, size)) return true;
    return false;
}

} // namespace acdf::input
