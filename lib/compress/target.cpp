#include "compress/target.h"

#include "compress/parallel.h"
#include "compress/sum.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace acdf::compress {
namespace {

constexpr std::uint32_t kBlock = 64; // a tile of 64 x 64 floats stays in the cache while it is turned

} // namespace

Target of_values(const Target& target) {
    Target out;
    out.columns = target.columns;
    out.rows = target.rows;
    out.values = target.values;
    out.column_measure = target.column_measure;
    out.row_measure = target.row_measure;
    out.column_axis = target.column_axis;
    out.row_axis = target.row_axis;
    out.total = target.total;
    out.mean_square = target.mean_square;
    out.parameterization = target.parameterization;
    return out;
}

Target transposed(const Target& target) {
    Target out;
    out.columns = target.rows;
    out.rows = target.columns;
    out.column_measure = target.row_measure;
    out.row_measure = target.column_measure;
    out.column_axis = target.row_axis;
    out.row_axis = target.column_axis;
    out.total = target.total;
    out.mean_square = target.mean_square;
    out.parameterization = target.parameterization;
    out.values.resize(target.values.size());
    const std::uint32_t blocks = (target.rows + kBlock - 1) / kBlock;
    parallel_for(std::uint32_t{0}, blocks, [&](std::uint32_t block) {
        const std::uint32_t r0 = block * kBlock, r1 = std::min(r0 + kBlock, target.rows);
        for (std::uint32_t c0 = 0; c0 < target.columns; c0 += kBlock) {
            const std::uint32_t c1 = std::min(c0 + kBlock, target.columns);
            for (std::uint32_t c = c0; c < c1; ++c)
                for (std::uint32_t r = r0; r < r1; ++r)
                    out.values[std::size_t{c} * out.columns + r] =
                        target.values[std::size_t{r} * target.columns + c];
        }
    });
    return out;
}

void refuse_overflow(const Target& target) {
    if (!std::all_of(target.values.begin(), target.values.end(), [](float v) { return std::isfinite(v); }))
        throw std::invalid_argument(
            "the channels of the radiance add up to more than a float holds; scale it down");
}

bool has_energy(const Target& target) {
    for (std::uint32_t r = 0; r < target.rows; ++r)
        for (std::uint32_t c = 0; c < target.columns; ++c)
            if (target.row(r)[c] * target.column_measure[c] * target.row_measure[r] > 0.0) return true;
    return false;
}

double integral(const Target& target) {
    Sum total;
    for (std::uint32_t r = 0; r < target.rows; ++r) {
        const float* row = target.row(r);
        PlainerSum sum;
        for (std::uint32_t c = 0; c < target.columns; ++c) sum.add(row[c] * target.column_measure[c]);
        total.add(sum.value() * target.row_measure[r]);
    }
    return total.value();
}

const Target& of_texels(const Target& target, Target& other) {
    if (target.peaks.empty()) return target;
    other = target;
    other.peaks = {};
    return other;
}

double least_second_moment(const Target& target) {
    const double g = integral(target);
    return target.mean_square > 0.0 ? g * g / target.mean_square : 1.0;
}

} // namespace acdf::compress
