#include "measure/samplers/tiling.h"

#include "compress/sum.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <stdexcept>

namespace acdf::measure {
namespace {

using compress::Sum;
using compress::Target;

/// Added to the largest cosines: what rounds to a direction above the horizon must lie in a tile with weight.
constexpr double kSlack = 0x1p-20;

/// A tile as a target of its own.
Target part(const Target& target, std::uint32_t column0, std::uint32_t column1, std::uint32_t row0,
            std::uint32_t row1) {
    Target out;
    out.columns = column1 - column0;
    out.rows = row1 - row0;
    out.column_measure.assign(target.column_measure.begin() + column0, target.column_measure.begin() + column1);
    out.row_measure.assign(target.row_measure.begin() + row0, target.row_measure.begin() + row1);
    for (std::uint32_t r = row0; r < row1; ++r)
        out.values.insert(out.values.end(), target.row(r) + column0, target.row(r) + column1);
    return out;
}

} // namespace

TilingOnTheFly::Borders TilingOnTheFly::borders(std::uint32_t texels, std::uint32_t tiles, bool azimuth) {
    if (tiles == 0 || tiles > texels || tiles > 0xFFFF)
        throw std::invalid_argument("a tiling needs 1 tile along an axis, and at most as many as texels");
    Borders out;
    for (std::uint32_t i = 0; i <= tiles; ++i) {
        const auto at = static_cast<std::uint32_t>(std::uint64_t{i} * texels / tiles);
        double sine, cosine;
        acdf_sincospi(azimuth ? 1.0 - 2.0 * at / texels : double(at) / texels, &sine, &cosine);
        out.at.push_back(at);
        out.cosine.push_back(cosine);
        out.sine.push_back(std::max(sine, azimuth ? -1.0 : 0.0));
        out.tile.resize(at, static_cast<std::uint16_t>(i - 1));
    }
    return out;
}

TilingOnTheFly::TilingOnTheFly(const Target& target, std::uint32_t columns, std::uint32_t rows)
    : target_(target), grid_(target), columns_(borders(target.columns, columns, true)),
      rows_(borders(target.rows, rows, false)), cosines_(target) {
    for (std::uint32_t r = 0; r < rows; ++r)
        for (std::uint32_t c = 0; c < columns; ++c) {
            const Target tile = part(target, columns_.at[c], columns_.at[c + 1], rows_.at[r], rows_.at[r + 1]);
            tables_.emplace_back(tile);
            flux_.push_back(compress::integral(tile));
            if (target.parameterization != ACDF_PARAM_OCTAHEDRAL) continue;
            const double low[2] = {double(columns_.at[c]) / target.columns, double(rows_.at[r]) / target.rows};
            const double high[2] = {double(columns_.at[c + 1]) / target.columns,
                                    double(rows_.at[r + 1]) / target.rows};
            cones_.push_back(SquareCone::around(low, high));
        }
}

// On a lat-long grid, the cosine of n with (theta, phi) is n.z cos(theta) + b sin(theta) with b = n.x cos(phi) +
// n.y sin(phi). As sin(theta) >= 0, the largest b of the tile's azimuths comes first: that of n itself if the tile
// has it, else at one of the two borders. Then it is a cosine of theta - atan2(b, n.z): at its crest if that lies
// in the tile, else at a border.
void TilingOnTheFly::largest_cosines(const float n[3], double* across, double* bound) const {
    for (std::size_t t = 0; t < cones_.size(); ++t) bound[t] = std::max(cones_[t].largest_cosine(n) + kSlack, 0.0);
    if (!cones_.empty()) return;
    const std::size_t columns = columns_.at.size() - 1, rows = rows_.at.size() - 1;
    const double x = n[0], y = n[1], z = n[2];
    const double column = target_.columns * (0.5 - 0.5 * acdf_atan2pi(y, x));
    const std::size_t own = columns_.tile[std::min(static_cast<std::uint32_t>(column), target_.columns - 1)];
    for (std::size_t c = 0; c < columns; ++c) {
        const double left = x * columns_.cosine[c] + y * columns_.sine[c];
        const double right = x * columns_.cosine[c + 1] + y * columns_.sine[c + 1];
        const double b = c == own ? std::sqrt(x * x + y * y) : std::max(left, right);
        across[c] = b;
        across[columns + c] = std::sqrt(z * z + b * b);
    }
    for (std::size_t r = 0; r < rows; ++r) {
        const double c0 = rows_.cosine[r], s0 = rows_.sine[r], c1 = rows_.cosine[r + 1], s1 = rows_.sine[r + 1];
        for (std::size_t c = 0; c < columns; ++c) {
            const double b = across[c];
            const double border = std::max(z * c0 + b * s0, z * c1 + b * s1);
            const bool rises = b * c0 >= z * s0, falls = b * c1 <= z * s1; // at the top and at the foot
            bound[r * columns + c] = std::max((rises && falls ? across[columns + c] : border) + kSlack, 0.0);
        }
    }
}

void TilingOnTheFly::at(const float n[3], Point& point, const float* factors) const {
    point.cumulative.resize(tiles() + 1);
    point.across.resize(2 * (columns_.at.size() - 1));
    largest_cosines(n, point.across.data(), point.cumulative.data() + 1);
    point.cumulative[0] = 0.0;
    for (std::size_t t = 0; t < tiles(); ++t)
        point.cumulative[t + 1] =
            point.cumulative[t] + point.cumulative[t + 1] * flux_[t] * (factors ? double{factors[t]} : 1.0);
}

TilingOnTheFly::Point TilingOnTheFly::at(const float n[3]) const {
    Point point;
    at(n, point);
    return point;
}

AcdfDirectionSample TilingOnTheFly::sample(const Point& point, double u0, double u1) const {
    const std::vector<double>& sums = point.cumulative;
    const double total = sums.back();
    if (!(total > 0.0)) return {{0.0f, 0.0f, 1.0f}, 0.0f};
    // The first sum above u1: tiles of weight 0 are never sampled.
    const double scaled = std::min(u1 * total, total * (1.0 - 0x1p-53));
    const auto t =
        static_cast<std::size_t>(std::upper_bound(sums.begin() + 1, sums.end(), scaled) - (sums.begin() + 1));
    const double weight = sums[t + 1] - sums[t];
    const double within = std::min((scaled - sums[t]) / weight, 1.0 - 0x1p-24);
    AcdfDirectionSample out = sample_tile(t, u0, within);
    out.pdf = static_cast<float>(double{out.pdf} * (weight / total));
    return out;
}

AcdfDirectionSample TilingOnTheFly::sample_tile(std::size_t tile, double u0, double u1) const {
    FullCdf::Draw draw = tables_[tile].sample(static_cast<float>(u0), static_cast<float>(u1));
    const std::size_t columns = columns_.at.size() - 1;
    draw.column += columns_.at[tile % columns];
    draw.row += rows_.at[tile / columns];
    return grid_.place(draw);
}

float TilingOnTheFly::pdf(const Point& point, const float direction[3]) const {
    std::uint32_t square[2];
    if (!grid_.find(direction, square)) return 0.0f;
    const std::size_t tile_column = columns_.tile[square[0]], tile_row = rows_.tile[square[1]];
    const std::size_t t = tile_row * (columns_.at.size() - 1) + tile_column;
    const double weight = point.cumulative[t + 1] - point.cumulative[t];
    if (!(weight > 0.0)) return 0.0f;
    const double within = tables_[t].pdf(square[0] - columns_.at[tile_column], square[1] - rows_.at[tile_row]);
    return static_cast<float>(within * (weight / point.cumulative.back()));
}

double TilingOnTheFly::relative_variance(const float n[3]) const {
    std::vector<double> bound(tiles()), cosine2(columns_.at.size() - 1), across(2 * cosine2.size());
    largest_cosines(n, across.data(), bound.data());
    const double total = std::inner_product(bound.begin(), bound.end(), flux_.begin(), 0.0);
    Sum irradiance[3], second;
    for (std::uint32_t r = 0; r < target_.rows; ++r) {
        const float* row = target_.row(r);
        double lit_means[3] = {};
        std::fill(cosine2.begin(), cosine2.end(), 0.0);
        cosines_.for_each_above(n, r, [&](std::uint32_t c, double cosine) {
            const double lit = row[c] * target_.column_measure[c] * cosine;
            double means[3];
            const std::size_t channels = compress::means_of(target_, std::size_t{r} * target_.columns + c, means);
            for (std::size_t k = 0; k < channels; ++k)
                lit_means[k] += means[k] * target_.column_measure[c] * cosine;
            cosine2[columns_.tile[c]] += lit * cosine;
        });
        for (std::size_t k = 0; k < 3; ++k) irradiance[k].add(lit_means[k] * target_.row_measure[r]);
        const double* of_row = bound.data() + rows_.tile[r] * cosine2.size();
        for (std::size_t c = 0; c < cosine2.size(); ++c)
            if (cosine2[c] > 0.0) second.add(cosine2[c] * target_.row_measure[r] / of_row[c]);
    }
    const double mean = std::hypot(irradiance[0].value(), irradiance[1].value(), irradiance[2].value());
    return mean > 0.0 ? std::max(0.0, total * second.value() / (mean * mean) - 1.0) : 0.0;
}

std::uint64_t TilingOnTheFly::bytes() const {
    std::uint64_t sum = flux_.size() * sizeof(double) + cones_.size() * sizeof(SquareCone);
    for (const FullCdf& table : tables_) sum += table.bytes();
    for (const Borders* axis : {&columns_, &rows_})
        sum += axis->at.size() * (sizeof(std::uint32_t) + 2 * sizeof(double)) +
               axis->tile.size() * sizeof(std::uint16_t);
    return sum;
}

} // namespace acdf::measure
