#include "measure/samplers/hierarchical_warp.h"

#include <algorithm>

namespace acdf::measure {
namespace {

/// False with probability low / (low + high), which are not both 0; u becomes what is left of it.
bool second(float low, float high, double& u) {
    const double scaled = u * (double{low} + double{high});
    const bool yes = scaled >= low && high > 0.0f;
    u = std::min(yes ? (scaled - low) / high : scaled / low, 1.0 - 0x1p-53);
    return yes;
}

} // namespace

HierarchicalWarp::HierarchicalWarp(const compress::Target& target) : grid_(target) {
    std::uint32_t columns = target.columns, rows = target.rows;
    std::vector<double> flux, above;
    for (std::uint32_t r = 0; r < rows; ++r) {
        solid_angle_.push_back(target.row_measure[r] * target.column_measure[0]);
        for (std::uint32_t c = 0; c < columns; ++c)
            flux.push_back(target.row(r)[c] / grid_.flux() * target.column_measure[c] * target.row_measure[r]);
    }
    do {
        const std::uint32_t half_columns = (columns + 1) / 2, half_rows = (rows + 1) / 2;
        Level level{half_columns, std::vector<Quad>(std::size_t{half_columns} * half_rows)};
        above.assign(level.quads.size(), 0.0);
        for (std::uint32_t r = 0; r < rows; ++r)
            for (std::uint32_t c = 0; c < columns; ++c) {
                const std::size_t quad = std::size_t{r / 2} * half_columns + c / 2;
                const double share = flux[std::size_t{r} * columns + c];
                level.quads[quad].share[2 * (r % 2) + c % 2] = static_cast<float>(share);
                above[quad] += share;
            }
        levels_.push_back(std::move(level));
        flux.swap(above);
        columns = half_columns;
        rows = half_rows;
    } while (flux.size() > 1);
}

AcdfDirectionSample HierarchicalWarp::sample(double u0, double u1) const {
    std::uint32_t column = 0, row = 0;
    double share = 1.0;
    for (auto level = levels_.rbegin(); level != levels_.rend(); ++level) {
        const float* s = level->quads[std::size_t{row} * level->columns + column].share;
        const bool lower = second(s[0] + s[1], s[2] + s[3], u1);
        const bool right = second(s[2 * lower], s[2 * lower + 1], u0);
        share = s[2 * lower + right];
        row = 2 * row + lower;
        column = 2 * column + right;
    }
    return grid_.place(column, row, u0, u1, share / solid_angle_[row]);
}

float HierarchicalWarp::pdf(const float direction[3]) const {
    std::uint32_t texel[2];
    if (!grid_.find(direction, texel)) return 0.0f;
    const Level& level = levels_.front();
    const Quad& quad = level.quads[std::size_t{texel[1] / 2} * level.columns + texel[0] / 2];
    return static_cast<float>(quad.share[2 * (texel[1] % 2) + texel[0] % 2] / solid_angle_[texel[1]]);
}

std::uint64_t HierarchicalWarp::bytes() const {
    std::uint64_t sum = solid_angle_.size() * sizeof(double);
    for (const Level& level : levels_) sum += level.quads.size() * sizeof(Quad);
    return sum;
}

} // namespace acdf::measure
