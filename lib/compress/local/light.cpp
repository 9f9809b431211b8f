#include "compress/local/light.h"

#include "compress/boxes.h"
#include "compress/parallel.h"
#include "compress/sum.h"

#include <acdf/sample.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>

namespace acdf::compress {
namespace {

constexpr double kPointStep = 0.02; // radians across which light is taken to have one cosine

double solid_angle(const Target& target, const Box& box) {
    if (is_octahedral(target))
        return 4.0 * ACDF_PI * (double(box.length(0)) / target.rows) * (double(box.length(1)) / target.columns);
    return 2.0 * ACDF_PI / target.columns * box.length(1) *
           (acdf_row_z(box.begin[0], target.rows) - acdf_row_z(box.end[0], target.rows));
}

/// Part `part` of `parts` of the steps of an axis.
Box part_of(Box box, std::size_t axis, std::uint32_t part, std::uint32_t parts) {
    const std::uint32_t begin = box.begin[axis], length = box.length(axis);
    box.begin[axis] = begin + std::uint32_t(std::uint64_t{length} * part / parts);
    box.end[axis] = begin + std::uint32_t(std::uint64_t{length} * (part + 1) / parts);
    return box;
}

/// Blocks of at most about kPointStep.
std::vector<Box> blocks_of(const Target& target) {
    const auto count = [&](std::uint32_t steps, double radians) {
        return static_cast<std::uint32_t>(std::clamp(std::ceil(radians / kPointStep), 1.0, double(steps)));
    };
    // The side of the octahedral square is as long as that of one of 4 pi.
    const bool octahedral = is_octahedral(target);
    const double side = 2.0 * std::sqrt(ACDF_PI);
    const std::uint32_t rows = count(target.rows, octahedral ? side : ACDF_PI);
    const Box all{{}, {target.rows, target.columns}};
    std::vector<Box> out;
    for (std::uint32_t i = 0; i < rows; ++i) {
        const Box band = part_of(all, 0, i, rows);
        const double z = centre(target, band)[2];
        const double around = octahedral ? side : 2.0 * ACDF_PI * std::sqrt(1.0 - z * z);
        const std::uint32_t columns = count(target.columns, around);
        for (std::uint32_t k = 0; k < columns; ++k) out.push_back(part_of(band, 1, k, columns));
    }
    return out;
}

} // namespace

Direction direction_at(const Target& target, double row, double column) {
    if (is_octahedral(target)) return octahedral_direction(target, column, row);
    double s, c, z, r;
    acdf_sincospi(1.0 - 2.0 * column / target.columns, &s, &c);
    acdf_sincospi(row / target.rows, &r, &z);
    return {r * c, r * s, z};
}

std::vector<LightPoint> light_points(const Target& target) {
    const std::vector<Box> blocks = blocks_of(target);
    std::vector<LightPoint> points(blocks.size());
    parallel_for(std::size_t{0}, blocks.size(), [&](std::size_t i) {
        Sum sum;
        for (std::uint32_t r = blocks[i].begin[0]; r < blocks[i].end[0]; ++r)
            for (std::uint32_t c = blocks[i].begin[1]; c < blocks[i].end[1]; ++c)
                sum.add(target.row(r)[c] * target.row_measure[r] * target.column_measure[c]);
        points[i] = {centre(target, blocks[i]), sum.value(), solid_angle(target, blocks[i])};
    });
    return points;
}

} // namespace acdf::compress
