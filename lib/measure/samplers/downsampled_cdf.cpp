#include "measure/samplers/downsampled_cdf.h"

#include "compress/sum.h"

#include <algorithm>
#include <stdexcept>
#include <vector>

namespace acdf::measure {
namespace {

using compress::Target;

/// Where cell i of `cells` begins.
std::uint32_t border(std::uint32_t i, std::uint32_t texels, std::uint32_t cells) {
    return static_cast<std::uint32_t>(std::uint64_t{i} * texels / cells);
}

/// The cell of a texel: the last one that begins at or before it.
std::uint32_t cell_of(std::uint32_t texel, std::uint32_t texels, std::uint32_t cells) {
    return static_cast<std::uint32_t>(((std::uint64_t{texel} + 1) * cells - 1) / texels);
}

std::vector<double> sums(const std::vector<double>& measure, std::uint32_t cells) {
    std::vector<double> out(cells, 0.0);
    const auto texels = static_cast<std::uint32_t>(measure.size());
    for (std::uint32_t i = 0; i < texels; ++i) out[cell_of(i, texels, cells)] += measure[i];
    return out;
}

Target means(const Target& target, std::uint32_t columns, std::uint32_t rows) {
    if (columns == 0 || rows == 0 || columns > target.columns || rows > target.rows)
        throw std::invalid_argument("a downsampled CDF needs 1 cell along an axis, and at most as many as texels");
    Target out;
    out.columns = columns;
    out.rows = rows;
    out.column_measure = sums(target.column_measure, columns);
    out.row_measure = sums(target.row_measure, rows);
    std::vector<compress::Sum> flux(std::size_t{columns} * rows);
    for (std::uint32_t r = 0; r < target.rows; ++r)
        for (std::uint32_t c = 0; c < target.columns; ++c)
            flux[std::size_t{cell_of(r, target.rows, rows)} * columns + cell_of(c, target.columns, columns)].add(
                double{target.row(r)[c]} * target.column_measure[c] * target.row_measure[r]);
    for (std::size_t i = 0; i < flux.size(); ++i)
        out.values.push_back(
            static_cast<float>(flux[i].value() / (out.column_measure[i % columns] * out.row_measure[i / columns])));
    return out;
}

} // namespace

DownsampledCdf::DownsampledCdf(const Target& target, std::uint32_t columns, std::uint32_t rows)
    : grid_(target), columns_(columns), rows_(rows), cdf_(means(target, columns, rows)) {}

AcdfDirectionSample DownsampledCdf::sample(double u0, double u1) const {
    const FullCdf::Draw draw = cdf_.sample(static_cast<float>(u0), static_cast<float>(u1));
    const auto column = static_cast<std::uint32_t>(draw.column), row = static_cast<std::uint32_t>(draw.row);
    const AcdfRange range[2] = {
        {border(column, grid_.columns(), columns_), border(column + 1, grid_.columns(), columns_)},
        {border(row, grid_.rows(), rows_), border(row + 1, grid_.rows(), rows_)}};
    return grid_.place(range, draw.column - column, draw.row - row, draw.pdf);
}

float DownsampledCdf::pdf(const float direction[3]) const {
    std::uint32_t texel[2];
    if (!grid_.find(direction, texel)) return 0.0f;
    return static_cast<float>(
        cdf_.pdf(cell_of(texel[0], grid_.columns(), columns_), cell_of(texel[1], grid_.rows(), rows_)));
}

} // namespace acdf::measure
