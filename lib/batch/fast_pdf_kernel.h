// Pdfs of LocalBatch in files of the fast shape over vectors, as fast_kernel.h samples.
#pragma once

#include "batch/fast_cells.h"
#include "batch/local.h"
#include "batch/local_blocks_kernel.h"
#include "batch/row_vectors.h"

#include <algorithm>
#include <cstring>

namespace {

/// Directions of a block in cells.
struct FastSquares {
    FastCells cells;
    alignas(64) std::int32_t square[2][kRoom], tile[kRoom];
};

/// The same where rows are mixed.
struct FastFinds : FastSquares, FastPointLanes {
    std::uint64_t lit = 0; // lanes whose tiles are bright tiles
};

/* acdf_tile_block_at of all squares: each level for all of them before the next. Returns the lanes that get a
 * split instead of a tile. */
ACDF_LANE std::uint64_t find_tile_blocks(const AcdfLocal& local, std::size_t count, FastSquares* f) {
    const std::uint32_t* const words = acdf_local_words(local.tables);
    const AcdfTileBlocks& t = local.tables->blocks;
    const auto* const grid = (const std::uint16_t*)(const void*)(words + t.grid);
    const auto* const blocks = (const std::uint16_t*)(const void*)(words + t.blocks);
    std::uint64_t split = 0;
    for (std::size_t at = 0; at < count; at += ACDF_WIDTH) {
        const Ints s0 = loaded(&f->square[0][at]), s1 = loaded(&f->square[1][at]);
        stored(&f->tile[at], two_bytes_of(grid, (s1 >> t.shift[1] << t.bits0) + (s0 >> t.shift[0])));
    }
    for (std::uint32_t level = 0; level < t.levels; ++level)
        for (std::size_t at = 0; at < count; at += ACDF_WIDTH) {
            const Ints s0 = loaded(&f->square[0][at]), s1 = loaded(&f->square[1][at]);
            const Ints inside = (s1 >> t.fine[level][1] & 3) * 4 + (s0 >> t.fine[level][0] & 3);
            const Ints entry = loaded(&f->tile[at]), told = -(entry >> 15);
            const Ints finer = two_bytes_of(blocks, (entry & ~told) * 16 + inside);
            stored(&f->tile[at], finer ^ ((finer ^ entry) & told));
        }
    for (std::size_t at = 0; at < count; at += ACDF_WIDTH) {
        const Ints node = loaded(&f->tile[at]);
        stored(&f->tile[at], node & (std::int32_t)~ACDF_TILE_FLAG);
        split |= (std::uint64_t)sign_bits(~(node << 16)) << at;
    }
    return split;
}

/* The squares of directions. Returns the lanes that are left to single calls. */
ACDF_LANE std::uint64_t find_squares(const AcdfLocal& local, const float (*directions)[3], std::size_t count,
                                     FastSquares* f) {
    const AcdfEnvironment& grid = local.environment;
    std::uint64_t lost = 0;
    for (std::size_t first = 0; first < count; first += kLanes) {
        const std::size_t more = std::min(count - first, kLanes);
        float last[kLanes][3] = {};
        Signed square[2];
        if (more < kLanes) std::memcpy(last, directions + first, more * sizeof *directions);
        const Signed sure = squares_of(local.tables->octahedral != 0, grid.columns, grid.rows,
                                       more < kLanes ? last : directions + first, square);
        for (int axis = 0; axis < 2; ++axis) {
            const Signed kept = square[axis] & sure; /* of others any that the grid has */
            std::memcpy(&f->square[axis][first], &kept, sizeof kept);
        }
        lost |= (std::uint64_t)bits(~sure) << first;
    }
    return lost;
}

/* The tiles of all squares. */
ACDF_LANE void find_fast_tiles(const AcdfLocal& local, std::size_t count, FastSquares* f) {
    for (std::uint64_t left = find_tile_blocks(local, count, f); left; left &= left - 1) {
        const auto i = (std::size_t)__builtin_ctzll(left);
        const std::uint32_t square[2] = {(std::uint32_t)f->square[0][i], (std::uint32_t)f->square[1][i]};
        auto node = (std::uint32_t)f->tile[i];
        do {
            const AcdfSplit& split = local.blend.splits[node];
            node = split.child[acdf_split_upper(&split, square)];
        } while (!(node & ACDF_TILE_FLAG));
        f->tile[i] = (std::int32_t)(node & ~ACDF_TILE_FLAG);
    }
    for (std::size_t i = 0; i < count; ++i) enter_tile(local, (std::uint32_t)f->tile[i], i, &f->cells);
}

/* The cells of all squares in their tiles. */
ACDF_LANE void find_fast_cells(std::size_t count, FastSquares* f) {
    FastCells& c = f->cells;
    for (std::size_t at = 0; at < count; at += ACDF_WIDTH) {
        Ints shift[2];
        const FastBoxes box = boxes_of(c.tile + at, shift);
        for (int axis = 0; axis < 2; ++axis)
            stored(&c.index[axis][at], (loaded(&f->square[axis][at]) - box.low[axis]) >> shift[axis]);
    }
}

/* Cumulative values around the cells of a vector of lanes in their lists. */
ACDF_LANE void load_ends(const FastCells& c, std::size_t at, Ints ends[2]) {
    const std::int32_t *cell = c.index[0] + at, *line = c.index[1] + at;
    ends[0] = two_bytes_of(
        [&](std::size_t i) { return ends_at(line_of(c, at + i, (std::uint32_t)line[i]), (std::uint32_t)cell[i]); });
    ends[1] = two_bytes_of([&](std::size_t i) { return ends_at(c.list[at + i], (std::uint32_t)line[i]); });
}

/* acdf_local_fast_find of a vector but for what the cell has of its tile. Lanes whose tiles are bright tiles are
 * returned. */
ACDF_LANE void weigh_fast_tiles(std::size_t at, FastFinds* f) {
    Ints ends[kRows], around[kRows]; // of groups, and of tiles in theirs
    const std::int32_t* const tiles = f->tile + at;
    for (int row = 0; row < kRows; ++row) {
        ends[row] = words_of([&](std::size_t i) {
            return ends_of(f->rows, row, at + i, (std::uint32_t)tiles[i] / ACDF_FAST_GROUP);
        });
        around[row] = two_bytes_of([&](std::size_t i) { // what stands before the first row of tiles is of groups
            return ends_at((const std::uint8_t*)f->rows.tile_row[row][at + i], (std::uint32_t)tiles[i]);
        });
    }
    const Ints tile = loaded(tiles), last = Ints{} + (std::int32_t)(ACDF_FAST_GROUP - 1), number = tile & last;
    const FastGroups g = find_groups(f->rows, ends, tile > last, at);
    Ints share = {};
    for (int row = 0; row < kRows; ++row) {
        Ints before, end;
        split_ends(around[row], number, &before, &end);
        share += g.part[row] * (end - before);
    }
    stored(&f->cells.of[at], g.mass * to_doubles(share) * loaded(&f->rows.unit[at]));
    stored(&f->cells.all[at], select(g.whole > 1.0, g.whole, all(1.0)) * ACDF_FAST_STEPS);
    const Ints light = words_at(&f->cells.tile[at], offsetof(AcdfTileRecord, depth)) >> 16;
    f->lit |= (std::uint64_t)lanes(has(to_indices(light), 0xFFFF)) << at;
}

/* The same of a lane whose tile is a bright tile: no row gives it a probability. */
ACDF_LANE void weigh_light(const AcdfLocal& local, std::size_t i, FastFinds* f) {
    const std::uint32_t k = f->cells.tile[i]->light - 1u;
    AcdfScaledNormal at;
    for (int axis = 0; axis < 3; ++axis) at.normal[axis] = f->bright_tiles.normal[axis][i];
    at.length = f->bright_tiles.length[i];
    f->cells.of[i] = acdf_fast_bright_tile_weight(&local, &at, k);
    f->cells.all[i] = f->bright_tiles.sum[i] * ACDF_FAST_STEPS;
}

/* The pdfs of lanes whose cells are known. */
ACDF_LANE void store_pdfs(const AcdfLocal& local, const FastCells& c, std::size_t count, float* out) {
    for (std::size_t first = 0; first < count; first += kLanes) {
        Vector pdf[2];
        for (std::size_t half = 0; half < 2; ++half) {
            const std::size_t lane = first + ACDF_WIDTH * half;
            const FastBoxes box = narrowed(c, lane);
            Vector z[2];
            Ints ends[2];
            load_ends(c, lane, ends);
            pdf[half] = fast_cell_pdf(local, c, ends, box, heights_of(local, box, z), lane);
        }
        const Floats told = to_floats((Doubles)pdf[0], (Doubles)pdf[1]);
        if (count - first >= kLanes) std::memcpy(out + first, &told, sizeof told);
        else std::memcpy(out + first, &told, (count - first) * sizeof *out);
    }
}

/* Pdfs of up to kBlock lanes; `at` and `alone` as draw_block of local_kernel.h has them. */
template <class At, class Alone>
ACDF_LANE void fast_pdf_block(const AcdfLocal& local, const At& at, const Alone& alone,
                              const float (*directions)[3], std::size_t count, float* out) {
    FastFinds f;
    const std::size_t whole = (count + kLanes - 1) / kLanes * kLanes;
    std::uint64_t lost = 0;
    at(whole, count, [&](const FastPoints<false>& p, std::size_t first) {
        keep_points(p, first, &f);
        lost |= not_served(p, first);
    });
    end_points(local, &f);
    lost |= find_squares(local, directions, count, &f);
    find_fast_tiles(local, whole, &f);
    find_fast_cells(whole, &f);
    for (std::size_t first = 0; first < whole; first += ACDF_WIDTH) weigh_fast_tiles(first, &f);
    for (; f.lit; f.lit &= f.lit - 1) weigh_light(local, (std::size_t)__builtin_ctzll(f.lit), &f);
    store_pdfs(local, f.cells, count, out);
    leave_alone(lost, count, alone);
}

// ---- all of an array -------------------------------------------------------------------------------------------

/* `of`: normals, one each, or the point of all. */
template <class Of>
ACDF_LANE void pdf_all_fast(const AcdfLocal& local, Of of, const float (*directions)[3], std::size_t count,
                            float* out) {
    pdfs_in_blocks<kBlock, FastPoints<false>>(local, of, directions, count, out,
                                              [&](const auto&... rest) { fast_pdf_block(local, rest...); });
}

} // namespace
