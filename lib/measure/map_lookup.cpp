#include "measure/map_lookup.h"

#include <algorithm>
#include <cmath>

namespace acdf::measure {

bool MapLookup::find(const float direction[3], Blend& out) const {
    std::uint32_t square[2];
    double position[2];
    if (!acdf_grid_square(&grid_, direction, square, position)) return false;
    out = {};
    if (filter_ == ACDF_FILTER_NEAREST) {
        out.texel[0] = std::size_t{square[1]} * grid_.columns + square[0];
        out.weight[0] = 1.0;
        return true;
    }
    if (!acdf_grid_is_octahedral(&grid_)) {
        const double x = direction[0], y = direction[1], z = direction[2];
        position[1] = grid_.rows * acdf_atan2pi(std::sqrt(x * x + y * y), z);
    }
    const double x = position[0] - 0.5, y = position[1] - 0.5, left = std::floor(x), above = std::floor(y);
    const auto column = static_cast<std::int64_t>(left), row = static_cast<std::int64_t>(above);
    const double s = x - left, t = y - above;
    out.texel = {beside(column, row), beside(column + 1, row), beside(column, row + 1),
                 beside(column + 1, row + 1)};
    out.weight = {(1.0 - s) * (1.0 - t), s * (1.0 - t), (1.0 - s) * t, s * t};
    return true;
}

/// The texel at (column, row), which may be one outside of the map.
std::size_t MapLookup::beside(std::int64_t column, std::int64_t row) const {
    const std::int64_t columns = grid_.columns, rows = grid_.rows;
    if (!acdf_grid_is_octahedral(&grid_)) {
        column = (column + columns) % columns;
        row = repeats_ ? (row + rows) % rows : std::clamp(row, std::int64_t{0}, rows - 1);
        return static_cast<std::size_t>(row * columns + column);
    }
    if (row < 0 || row >= rows) { // the texel that mirrors it at the middle of the side
        row = std::clamp(row, std::int64_t{0}, rows - 1);
        column = columns - 1 - column;
    }
    if (column < 0 || column >= columns) {
        column = std::clamp(column, std::int64_t{0}, columns - 1);
        row = rows - 1 - row;
    }
    return static_cast<std::size_t>(row * columns + column);
}

} // namespace acdf::measure
