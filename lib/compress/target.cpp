#include "compress/target.h"

#include "compress/sum.h"

#include <acdf/sample.h>

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace acdf::compress {
namespace {

constexpr std::uint32_t kBlock = 64; // a tile of 64 x 64 floats stays in the cache while it is turned

} // namespace

Target environment_target(const float* rgb, std::uint32_t columns, std::uint32_t rows,
                          const ChannelWeights& weights) {
    Target target;
    target.columns = columns;
    target.rows = rows;
    target.column_axis = ACDF_AXIS_PHI;
    target.row_axis = ACDF_AXIS_THETA;
    target.column_measure.assign(columns, 2.0 * ACDF_PI / columns);
    target.row_measure.resize(rows);
    for (std::uint32_t r = 0; r < rows; ++r) target.row_measure[r] = acdf_row_z(r, rows) - acdf_row_z(r + 1, rows);

    target.values.resize(std::size_t{columns} * rows);
    tbb::parallel_for(tbb::blocked_range<std::size_t>(0, target.values.size(), 1 << 16), [&](const auto& range) {
        for (std::size_t i = range.begin(); i < range.end(); ++i) {
            const double r = rgb[3 * i], g = rgb[3 * i + 1], b = rgb[3 * i + 2];
            const double value =
                weights.r * std::max(r, 0.0) + weights.g * std::max(g, 0.0) + weights.b * std::max(b, 0.0);
            target.values[i] = static_cast<float>(value);
        }
    });
    if (!std::all_of(target.values.begin(), target.values.end(), [](float v) { return std::isfinite(v); }))
        throw std::invalid_argument("radiance that is not finite");
    return target;
}

Target transposed(const Target& target) {
    Target out;
    out.columns = target.rows;
    out.rows = target.columns;
    out.column_measure = target.row_measure;
    out.row_measure = target.column_measure;
    out.column_axis = target.row_axis;
    out.row_axis = target.column_axis;
    out.values.resize(target.values.size());
    const std::uint32_t blocks = (target.rows + kBlock - 1) / kBlock;
    tbb::parallel_for(std::uint32_t{0}, blocks, [&](std::uint32_t block) {
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

double integral(const Target& target) {
    Sum total;
    for (std::uint32_t r = 0; r < target.rows; ++r) {
        const float* row = target.row(r);
        Sum sum;
        for (std::uint32_t c = 0; c < target.columns; ++c) sum.add(row[c] * target.column_measure[c]);
        total.add(sum.value() * target.row_measure[r]);
    }
    return total.value();
}

} // namespace acdf::compress
