// Writes down what the fast shape has for shaders.
#include "tables/walk_tiles.h"

#include <algorithm>
#include <cmath>
#include <cstring>

namespace acdf {

namespace {

using u32 = std::uint32_t;

constexpr double kPi = 3.14159265358979323846;

std::size_t words_of(std::size_t bytes) { return (bytes + 3) / 4; }

std::size_t sum_bytes(const AcdfLocal& local) {
    return 2 * std::size_t{local.blend.tiles->row_count} * local.fast.ends;
}
std::size_t inner_bytes(const AcdfLocal& local) {
    return std::size_t{local.blend.tiles->row_count} * local.fast.stride;
}

} // namespace

// Those below a split whose box is known. A path passes at most 48 splits.
void WalkTiles::add_tiles(const AcdfLocal& local, u32 node, const AcdfRange* box) noexcept {
    if (!(node & ACDF_TILE_FLAG)) {
        const AcdfSplit& split = local.blend.splits[node];
        for (int upper = 0; upper < 2; ++upper) {
            AcdfRange part[2] = {box[0], box[1]};
            acdf_range_cut(&part[split.place & 7u], split.place >> 3, upper);
            add_tiles(local, split.child[upper], part);
        }
        return;
    }
    const u32 tile = node & ~ACDF_TILE_FLAG;
    const AcdfFastGrid grid = acdf_fast_grid(&local.fast, local.blend.roots[tile], box);
    Record& record = records_[tile];
    record.lows = box[0].low | box[1].low << 16;
    record.sides = (box[0].high - box[0].low - 1) | (box[1].high - box[1].low - 1) << 16;
    record.ends = local.blend.roots[tile] + 2;
    record.rest = grid.shift[0] | grid.shift[1] << 8 | acdf_local_light_of(&local, tile) << 16;
    grid_bytes_ =
        std::max(grid_bytes_, std::size_t{record.ends} + grid.count[1] * (std::size_t{grid.count[0]} + 1));
}

bool WalkTiles::make(const AcdfLocal& local) noexcept {
    const AcdfEnvironment& env = local.environment;
    if (!records_.add(local.blend.tiles->tile_count, {})) return false;
    AcdfRange whole[2];
    acdf_sphere_ranges(env.columns, env.rows, whole);
    add_tiles(local, acdf_blend_root(&local.blend), whole);
    for (u32 i = 0; i <= 2 * env.rows && env.parameterization == ACDF_PARAM_LATLONG; ++i)
        sines_.add(static_cast<float>(std::sin(std::min(i, 2 * env.rows - i) * (0.5 * kPi / env.rows))));
    const std::size_t most = std::max({sum_bytes(local) / 2, inner_bytes(local), grid_bytes_});
    words_ = header_words + 2 * std::size_t{local.blend.tiles->tile_count} +
             words_of(records_.bytes() + sines_.bytes()) + words_of(sum_bytes(local)) +
             words_of(inner_bytes(local)) + words_of(grid_bytes_);
    return !sines_.failed() && most <= 0xFFFFFFFFu;
}

void WalkTiles::place(const AcdfLocal& local, u32* words, std::size_t at) const noexcept {
    const auto put = [&](u32 where, const void* from, std::size_t bytes) {
        words[where] = static_cast<u32>(at);
        if (bytes > 0) std::memcpy(words + at, from, bytes);
        at += words_of(bytes);
    };
    words[ACDF_TILES_COLUMNS] = local.environment.columns;
    words[ACDF_TILES_ROWS] = local.environment.rows;
    words[ACDF_TILES_GROUPS] = acdf_fast_group_count(local.blend.tiles->tile_count);
    words[ACDF_TILES_ENDS] = local.fast.ends;
    words[ACDF_TILES_ROOT] = acdf_blend_root(&local.blend);
    put(ACDF_TILES_SPLITS, local.blend.splits, sizeof(AcdfSplit) * (local.blend.tiles->tile_count - 1));
    put(ACDF_TILES_RECORDS, records_.data(), records_.bytes());
    put(ACDF_TILES_SUMS, local.fast.groups, sum_bytes(local));
    put(ACDF_TILES_INNER, local.fast.tiles, inner_bytes(local));
    put(ACDF_TILES_GRIDS, local.fast.grid, grid_bytes_);
    put(ACDF_TILES_SINES, sines_.data(), sines_.bytes());
}

} // namespace acdf
