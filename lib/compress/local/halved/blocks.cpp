#include "compress/local/halved/blocks.h"

#include "compress/boxes.h"
#include "compress/parallel.h"

#include <acdf/octahedral.h>

#include <algorithm>
#include <cmath>

namespace acdf::compress {
namespace {

constexpr int kLatlongDepth[2] = {7, 8}; // 128 rows of 256 blocks
constexpr int kOctahedralDepth[2] = {7, 7};
constexpr int kPoints = 4;       // on a side of a box, from which its cone is found
constexpr double kMargin = 1e-5; // radians, for rounding

std::vector<double> halved(std::uint32_t steps, int depth) {
    std::vector<double> borders{0.0, double(steps)};
    for (int level = 0; level < depth; ++level) {
        std::vector<double> finer{0.0};
        for (std::size_t i = 0; i + 1 < borders.size(); ++i) {
            const double low = borders[i], high = borders[i + 1], middle = 0.5 * (low + high);
            finer.push_back(high - low > 1.0 ? std::floor(middle) : middle);
            finer.push_back(high);
        }
        borders = std::move(finer);
    }
    return borders;
}

/// The measures of blocks where texels are no larger, else of texels: what halving ends at.
std::vector<double> measures(const std::vector<double>& texels, const std::vector<double>& borders) {
    if (texels.size() + 1 <= borders.size()) return texels;
    std::vector<double> out;
    for (std::size_t i = 0; i + 1 < borders.size(); ++i) {
        double sum = 0.0;
        for (auto t = static_cast<std::size_t>(borders[i]); t < static_cast<std::size_t>(borders[i + 1]); ++t)
            sum += texels[t];
        out.push_back(sum);
    }
    return out;
}

std::uint32_t at_depth(std::uint32_t number, std::uint32_t blocks) {
    while (number >= 2 * blocks) number /= 2;
    for (bool first = true; number < blocks; first = false) number = 2 * number + (first ? 1 : 0);
    return number;
}

} // namespace

Blocks::Blocks(const Target& grid)
    : grid_(grid), borders_{halved(grid.rows, (is_octahedral(grid) ? kOctahedralDepth : kLatlongDepth)[0]),
                            halved(grid.columns, (is_octahedral(grid) ? kOctahedralDepth : kLatlongDepth)[1])},
      axes_{HalvedAxis(measures(grid.row_measure, borders_[0])),
            HalvedAxis(measures(grid.column_measure, borders_[1]))},
      cones_(size()) {
    std::vector<Direction> sums(size(), Direction{});
    for (std::uint32_t r = rows(); r < 2 * rows(); ++r)
        for (std::uint32_t c = columns(); c < 2 * columns(); ++c) {
            const Direction d = middle({r, c});
            const double z = is_octahedral(grid) ? 1.0 : std::sqrt(std::max(1e-6, 1.0 - d[2] * d[2]));
            for (std::size_t k = 0; k < 3; ++k) sums[index({r, c})][k] = z * d[k];
        }
    for (std::uint32_t r = 2 * rows(); r-- > 1;)
        for (std::uint32_t c = 2 * columns(); c-- > 1;) {
            const int axis = c < columns() ? 1 : 0;
            if (!can_halve({r, c}, axis)) continue;
            for (std::size_t k = 0; k < 3; ++k)
                sums[index({r, c})][k] =
                    sums[index(half({r, c}, axis, 0))][k] + sums[index(half({r, c}, axis, 1))][k];
        }
    parallel_for(std::uint32_t{1}, 2 * rows(), [&](std::uint32_t r) {
        for (std::uint32_t c = 1; c < 2 * columns(); ++c)
            cones_[index({r, c})] = cone_of({r, c}, sums[index({r, c})]);
    });
}

HalvedBox Blocks::around(HalvedBox box) const {
    while (box.rows >= 2 * rows()) box.rows /= 2;
    while (box.columns >= 2 * columns()) box.columns /= 2;
    return box;
}

HalvedBox Blocks::block_of(HalvedBox box) const {
    return {at_depth(box.rows, rows()), at_depth(box.columns, columns())};
}

Direction Blocks::middle(HalvedBox block) const {
    const std::uint32_t r = block.rows - rows(), c = block.columns - columns();
    return direction_at(grid_, 0.5 * (borders_[0][r] + borders_[0][r + 1]),
                        0.5 * (borders_[1][c] + borders_[1][c + 1]));
}

BoxCone Blocks::cone_of(HalvedBox box, const Direction& sum) const {
    const auto span = [&](std::uint32_t number, std::size_t axis, double out[2]) {
        const auto blocks = static_cast<std::uint32_t>(borders_[axis].size() - 1);
        std::uint32_t low = number, high = number + 1;
        while (low < blocks) low *= 2, high *= 2;
        out[0] = borders_[axis][low - blocks];
        out[1] = borders_[axis][high - blocks];
    };
    double row[2], column[2];
    span(box.rows, 0, row);
    span(box.columns, 1, column);
    const double tall = (row[1] - row[0]) / grid_.rows, wide = (column[1] - column[0]) / grid_.columns;
    const double length = std::sqrt(dot(sum, sum));
    BoxCone out{{0.0f, 0.0f, 1.0f}, 2.0f};
    const Direction axis = {sum[0] / length, sum[1] / length, sum[2] / length};
    const double around = is_octahedral(grid_) ? 1.0 : 2.0 * std::sqrt(std::max(0.0, 1.0 - axis[2] * axis[2]));
    out.longer = wide * around > tall ? 1 : 0;
    // No more than half a turn: the farthest direction is at the border.
    if (!(length > 1e-6) || (wide > 0.5 && wide < 1.0)) return out;
    for (std::size_t k = 0; k < 3; ++k) out.axis[k] = static_cast<float>(axis[k]);
    double nearest = 1.0;
    for (int i = 0; i <= kPoints; ++i) {
        const double t = double(i) / kPoints;
        const double r = row[0] + t * (row[1] - row[0]), c = column[0] + t * (column[1] - column[0]);
        for (const Direction& d : {direction_at(grid_, r, column[0]), direction_at(grid_, r, column[1]),
                                   direction_at(grid_, row[0], c), direction_at(grid_, row[1], c)})
            nearest = std::min(nearest, dot(axis, d));
    }
    // On a lat-long grid it is a corner, else it may lie between points.
    const double between =
        is_octahedral(grid_) ? 0.5 * ACDF_OCTAHEDRAL_SPEED * std::max(tall, wide) / kPoints : 0.0;
    const double angle = std::acos(std::clamp(nearest, -1.0, 1.0)) + between + kMargin;
    if (angle < 0.5 * ACDF_PI) out.sine = static_cast<float>(std::sin(angle));
    return out;
}

} // namespace acdf::compress
