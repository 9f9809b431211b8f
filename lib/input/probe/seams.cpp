#include "input/probe/seams.h"

#include "build/probe/cube.h"
#include "build/probe/source_lookup.h"

#include <algorithm>
#include <cmath>

namespace acdf::input {
namespace {

/// Differences of logarithms, so that lights do not outweigh all else.
class LogBrightness {
public:
    explicit LogBrightness(const Brightness& image) : image_(image), level_(image.black_level()) {}

    double at(int x, int y) const { return std::log(static_cast<double>(image_.at(x, y)) + level_); }
    double step(int x0, int y0, int x1, int y1) const { return std::abs(at(x0, y0) - at(x1, y1)); }

private:
    const Brightness& image_;
    double level_;
};

/// Texel i of side 0..3 of a square of n x n, `inward` texels from the border.
struct SidePosition {
    int x, y;
};
SidePosition on_side(int n, int side, int i, int inward) {
    const int last = n - 1;
    const int x[4] = {i, last - inward, i, inward}, y[4] = {inward, i, last - inward, i};
    return {x[side], y[side]};
}

} // namespace

bool goes_on_across_folds(const Brightness& image) {
    const int n = image.width();
    if (n < 16 || n % 2 != 0) return false;
    const LogBrightness log(image);
    const auto at = [&](int side, int i, int inward) {
        const SidePosition place = on_side(n, side, i, inward);
        return log.at(place.x, place.y);
    };
    // Sums of differences: across the fold; from a texel to the next one inward; between distant texels of a
    // border; and across the fold from some way inward on. Near the fold's middle all are neighbours, which proves
    // nothing.
    const int half = n / 2 - n / 16, depth = std::max(2, n / 16);
    double folded = 0.0, touching = 0.0, apart = 0.0, deep = 0.0;
    for (int side = 0; side < 4; ++side)
        for (int i = 0; i < half; ++i) {
            const double here = at(side, i, 0);
            folded += std::abs(here - at(side, n - 1 - i, 0));
            touching += std::abs(here - at(side, i, 1));
            apart += std::abs(here - at(side, (i + half / 2) % half, 0));
            deep += std::abs(at(side, i, depth) - at(side, n - 1 - i, depth));
        }
    const bool matches = folded <= 1.5 * touching && folded < 0.5 * apart;
    const bool is_mirrored = folded < 0.1 * touching || deep < 1.5 * folded;
    return matches && !is_mirrored;
}

bool back_face_is_upright(const Brightness& image) {
    const build::Map map{build::Layout::vertical_cross, image.width(), image.height()};
    const int n = build::cube_face_size(map), left = n, top = 3 * n;
    const LogBrightness log(image);
    double hanging = 0.0, upright = 0.0;
    for (int side = 0; side < 4; ++side)
        for (int i = 0; i < n; ++i) {
            const SidePosition inside = on_side(n, side, i, 0), outside = on_side(n, side, i, -1);
            const build::TexelPosition beside =
                build::texel_beside(map, left + inside.x, top + inside.y, left + outside.x, top + outside.y);
            const double there = log.at(beside.column, beside.row);
            hanging += std::abs(there - log.at(left + inside.x, top + inside.y));
            upright += std::abs(there - log.at(left + n - 1 - inside.x, top + n - 1 - inside.y));
        }
    return upright < 0.8 * hanging;
}

bool sides_do_not_meet(const Brightness& image) {
    const int width = image.width(), height = image.height(), half = width / 2;
    const LogBrightness log(image);
    const auto step = [&](int x0, int x1) {
        double sum = 0.0;
        for (int y = 0; y < height; ++y) sum += log.step(x0, y, x1, y);
        return sum / height;
    };
    // The middle one is left out: there two pictures may lie side by side.
    double largest = 0.0, way = 0.0, opposite = 0.0;
    for (int x = 0; x + 1 < width; ++x) {
        const double here = step(x, x + 1);
        way += here;
        if (x + 1 != half) largest = std::max(largest, here);
    }
    for (int x = 0; x < half; ++x) opposite += step(x, x + half) / half;
    const double seam = step(width - 1, 0);
    const bool is_edge = seam > 1.25 * largest && seam > 0.4 * opposite;
    const bool has_texture = way > 4.0 * seam; // not a ramp, nor a few lights with sharp edges
    return is_edge && has_texture;
}

} // namespace acdf::input
