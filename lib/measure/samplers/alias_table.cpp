#include "measure/samplers/alias_table.h"

#include "measure/samplers/alias_choices.h"

#include <algorithm>
#include <utility>

namespace acdf::measure {
namespace {

/// True with probability p, by u in [0, 1); u becomes what is left of it.
bool chosen(double p, double& u) {
    const bool yes = u < p;
    u = std::min(yes ? u / p : (u - p) / (1.0 - p), 1.0);
    return yes;
}

} // namespace

AliasTable::AliasTable(const compress::Target& target, AliasNumbers numbers) : grid_(target), numbers_(numbers) {
    std::vector<double> mass;
    for (std::uint32_t r = 0; r < target.rows; ++r)
        for (std::uint32_t c = 0; c < target.columns; ++c) {
            const double density = target.row(r)[c] / grid_.flux();
            entries_.push_back({1.0f, 0, static_cast<float>(density)});
            mass.push_back(density * target.column_measure[c] * target.row_measure[r] *
                           static_cast<double>(grid_.texels()));
        }
    const std::vector<AliasChoice> choices = alias_choices(std::move(mass));
    for (std::size_t i = 0; i < choices.size(); ++i) {
        entries_[i].keep = choices[i].keep;
        entries_[i].alias = choices[i].alias;
    }
}

AcdfDirectionSample AliasTable::sample(double u0, double u1) const {
    const double scaled = u0 * static_cast<double>(grid_.texels());
    std::size_t i = std::min(static_cast<std::size_t>(scaled), grid_.texels() - 1);
    double left = std::min(scaled - static_cast<double>(i), 1.0 - 0x1p-53);
    if (!chosen(entries_[i].keep, numbers_ == AliasNumbers::one ? left : u1)) i = entries_[i].alias;
    const auto column = static_cast<std::uint32_t>(i % grid_.columns());
    const auto row = static_cast<std::uint32_t>(i / grid_.columns());
    return grid_.place(column, row, left, u1, entries_[i].pdf);
}

float AliasTable::pdf(const float direction[3]) const {
    std::uint32_t texel[2];
    if (!grid_.find(direction, texel)) return 0.0f;
    return entries_[std::size_t{texel[1]} * grid_.columns() + texel[0]].pdf;
}

} // namespace acdf::measure
