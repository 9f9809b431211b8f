#include "compress/local/horizon.h"

#include <algorithm>
#include <cmath>

namespace acdf::compress {
namespace {

constexpr double kLeastReach = 0.002; // radians across which the part above the horizon is guessed

/// A part of a box, in texels.
struct Area {
    double begin[2], end[2];

    Area quarter(int row, int column) const {
        Area out = *this;
        const int upper[2] = {row, column};
        for (int axis = 0; axis < 2; ++axis)
            (upper[axis] ? out.begin : out.end)[axis] = 0.5 * (begin[axis] + end[axis]);
        return out;
    }
};

double mean_square(const Target& target, const Area& area, const Direction& normal) {
    const Direction middle =
        direction_at(target, 0.5 * (area.begin[0] + area.end[0]), 0.5 * (area.begin[1] + area.end[1]));
    double reach = 0.0;
    for (const double row : {area.begin[0], area.end[0]})
        for (const double column : {area.begin[1], area.end[1]}) {
            const Direction corner = direction_at(target, row, column);
            reach =
                std::max(reach, std::hypot(corner[0] - middle[0], corner[1] - middle[1], corner[2] - middle[2]));
        }
    const double height = dot(middle, normal);
    if (height <= -reach - kHorizonMargin) return 0.0;
    if (height >= reach) return height * height;
    if (reach < kLeastReach) {
        const double above = 0.5 * (height + reach + kHorizonMargin);
        return above * above;
    }
    double sum = 0.0;
    for (int part = 0; part < 4; ++part) sum += mean_square(target, area.quarter(part / 2, part % 2), normal);
    return 0.25 * sum;
}

} // namespace

double mean_cosine(const Target& target, const Box& box, const Direction& normal) {
    const Area area{{double(box.begin[0]), double(box.begin[1])}, {double(box.end[0]), double(box.end[1])}};
    return std::sqrt(mean_square(target, area, normal));
}

} // namespace acdf::compress
