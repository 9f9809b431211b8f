#include "measure/samplers/ideal_row.h"

#include <algorithm>
#include <cmath>

namespace acdf::measure {

IdealRows::IdealRows(const compress::Target& target, double shares)
    : grid_(target), shares_(shares), reach_(0.0), radiance_(target.values) {
    const AcdfGrid grid{target.columns, target.rows, static_cast<std::uint32_t>(target.parameterization)};
    reach_ = 2.3 / target.rows; // half a diagonal, on the equator of a lat-long map and in the octahedral square
    for (std::uint32_t r = 0; r < target.rows; ++r) {
        measure_.push_back(target.row_measure[r] * target.column_measure[0]);
        for (std::uint32_t c = 0; c < target.columns; ++c) {
            const AcdfRange range[2] = {{c, c + 1}, {r, r + 1}};
            const double half[2] = {0.5, 0.5};
            const AcdfDirectionSample middle = acdf_grid_position(&grid, range, half, 1.0);
            middle_.push_back({middle.direction[0], middle.direction[1], middle.direction[2]});
        }
    }
}

/// What is sampled of a texel of radiance L: L - threshold, times the cosine.
double IdealRow::taken(const Texel& texel, double threshold) const {
    const double excess = static_cast<double>(rows_.radiance_[texel.index]) - threshold;
    return excess > 0.0 ? excess * texel.cosine * rows_.measure_[texel.index / rows_.grid_.columns()] : 0.0;
}

/// The radiance at which what is left comes to `shares` times what the cosine gives at it.
double IdealRow::fill() {
    if (!(rows_.shares_ > 0.0)) return 0.0;
    const auto sum = [&](double threshold) {
        double out = 0.0;
        for (const Texel& texel : texels_) out += taken(texel, threshold);
        return out;
    };
    double high = sum(0.0) / (rows_.shares_ * ACDF_PI), low = 1e-6 * high;
    for (int step = 0; step < 30 && high > 0.0; ++step) {
        const double middle = std::sqrt(low * high);
        (sum(middle) > rows_.shares_ * ACDF_PI * middle ? low : high) = middle;
    }
    return low;
}

void IdealRow::move_to(const ShadingPoint& point) {
    texels_.clear();
    density_.assign(rows_.radiance_.size(), 0.0f);
    for (std::uint32_t i = 0; i < density_.size(); ++i) {
        if (!(rows_.radiance_[i] > 0.0f)) continue;
        const auto& d = rows_.middle_[i];
        const double cosine = static_cast<double>(point.n[0] * d[0] + point.n[1] * d[1] + point.n[2] * d[2]);
        if (cosine > -rows_.reach_) texels_.push_back({i, std::max(cosine, 0.25 * rows_.reach_), 0.0});
    }
    const double threshold = fill();
    double sum = 0.0;
    for (Texel& texel : texels_) texel.upto = sum += taken(texel, threshold);
    for (const Texel& texel : texels_)
        density_[texel.index] =
            static_cast<float>(taken(texel, threshold) / sum / rows_.measure_[texel.index / rows_.grid_.columns()]);
}

AcdfDirectionSample IdealRow::sample(double u0, double u1) const {
    if (texels_.empty() || !(texels_.back().upto > 0.0)) return {{0.0f, 0.0f, 1.0f}, 0.0f};
    const double x = u0 * texels_.back().upto;
    auto found = std::upper_bound(texels_.begin(), texels_.end(), x,
                                  [](double value, const Texel& texel) { return value < texel.upto; });
    if (found == texels_.end()) --found;
    const double before = found == texels_.begin() ? 0.0 : (found - 1)->upto;
    const double inside = found->upto > before ? std::clamp((x - before) / (found->upto - before), 0.0, 1.0) : 0.5;
    return rows_.grid_.place(found->index % rows_.grid_.columns(), found->index / rows_.grid_.columns(), inside, u1,
                             static_cast<double>(density_[found->index]));
}

float IdealRow::pdf(const float wi[3]) const {
    std::uint32_t texel[2];
    if (!rows_.grid_.find(wi, texel)) return 0.0f;
    return density_[std::size_t{texel[1]} * rows_.grid_.columns() + texel[0]];
}

} // namespace acdf::measure
