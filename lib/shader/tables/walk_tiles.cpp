// Writes down what the fast shape has for shaders.
#include "shader/tables/walk_tiles.h"

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

void WalkTiles::add(const AcdfLocal& local, u32 tile) noexcept {
    AcdfRange box[2];
    acdf_sphere_ranges(local.environment.columns, local.environment.rows, box);
    const AcdfFastGrid grid = acdf_local_fast_sampled(&local, tile, box);
    Record record;
    record.lows = box[0].low | box[1].low << 16;
    record.sides = (box[0].high - box[0].low - 1) | (box[1].high - box[1].low - 1) << 16;
    record.ends = static_cast<u32>(grid.ends - local.fast.grid);
    record.rest = grid.shift[0] | grid.shift[1] << 8 | acdf_local_bright_tile_of(&local, tile) << 16;
    records_.add(record);
    grid_bytes_ =
        std::max(grid_bytes_, std::size_t{record.ends} + grid.count[1] * (std::size_t{grid.count[0]} + 1));
}

bool WalkTiles::make(const AcdfLocal& local) noexcept {
    const AcdfEnvironment& env = local.environment;
    for (u32 tile = 0; tile < local.blend.tiles->tile_count; ++tile) add(local, tile);
    for (u32 i = 0; i <= 2 * env.rows && env.parameterization == ACDF_PARAM_LATLONG; ++i)
        sines_.add(static_cast<float>(std::sin(std::min(i, 2 * env.rows - i) * (0.5 * kPi / env.rows))));
    const std::size_t most = std::max({sum_bytes(local) / 2, inner_bytes(local), grid_bytes_});
    words_ = header_words + 2 * std::size_t{local.blend.tiles->tile_count} +
             words_of(records_.bytes() + sines_.bytes()) + words_of(sum_bytes(local)) +
             words_of(inner_bytes(local)) + words_of(grid_bytes_);
    return !(records_.failed() || sines_.failed()) && most <= 0xFFFFFFFFu;
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
