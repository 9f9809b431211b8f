// Pdfs of LocalBatch over vectors, operation by operation as in acdf/local.h; see local_kernel.h.
#pragma once

#include "batch/local.h"
#include "batch/local_blocks_kernel.h"
#include "batch/local_curve_vectors.h"
#include "batch/local_light_vectors.h"
#include "batch/row_vectors.h"

#include <algorithm>
#include <cstring>

namespace {

// ---- squares ---------------------------------------------------------------------------------------------------

/* The squares of kLanes directions, into the lanes from one on. Returns those that floats cannot decide. */
ACDF_LANE std::uint32_t find_squares(const AcdfLocal& local, const float (*directions)[3], std::size_t first,
                                     Cells* cells) {
    const AcdfEnvironment& grid = local.environment;
    Signed square[2];
    const Signed sure = squares_of(local.tables->octahedral != 0, grid.columns, grid.rows, directions, square);
    for (int axis = 0; axis < 2; ++axis) /* of others any that the grid has */
        for (int half = 0; half < 2; ++half)
            stored(&cells->square[axis][first + ACDF_WIDTH * (std::size_t)half],
                   widened(square[axis] & sure, half));
    return bits(~sure);
}

/* A step of acdf_tile_at of a vector. Returns whether any lane goes on. */
ACDF_LANE bool tile_step(const AcdfSplit* splits, std::size_t at, Cells* cells) {
    const Integer node = loaded(&cells->tile[at]), split = loaded_from(splits, node & 0x7FFF);
    const Integer square = choose(has(split, 1), loaded(&cells->square[1][at]), loaded(&cells->square[0][at]));
    const Mask below = negative((square << 3 | 7) - (split & 0xFFFFFFFF));
    const Integer child = choose(below, split, split >> 16) >> 32 & 0xFFFF;
    const Integer reached = choose(has(node, ACDF_TILE_FLAG), node, child);
    stored(&cells->tile[at], reached);
    return lanes(has(reached, ACDF_TILE_FLAG)) + 1 != 1u << ACDF_WIDTH;
}

/* acdf_tile_at of all lanes, and of those behind them that have squares: one step of each vector in turn. */
ACDF_LANE void find_tiles(const AcdfLocalTables& tables, Cells* cells) {
    const std::uint32_t* const words = acdf_local_words(&tables);
    const AcdfTileTables& t = tables.tiles;
    const Integer grid = Integer{} + (long long)(std::uintptr_t)(words + t.grid);
    std::size_t live[kRoom / ACDF_WIDTH], going = 0;
    for (std::size_t at = 0; at < cells->count; at += ACDF_WIDTH) {
        const Integer column = loaded(&cells->square[0][at]) >> t.shift[0];
        const Integer row = loaded(&cells->square[1][at]) >> t.shift[1];
        const Integer node = two_bytes_at(grid + ((row << t.bits0) + column) * 2);
        stored(&cells->tile[at], node);
        live[going] = at;
        going += lanes(has(node, ACDF_TILE_FLAG)) + 1 != 1u << ACDF_WIDTH;
    }
    while (going > 0) {
        std::size_t left = 0;
        for (std::size_t k = 0; k < going; ++k) {
            const std::size_t at = live[k];
            live[left] = at;
            left += tile_step(acdf_tile_splits(words, &t), at, cells);
        }
        going = left;
    }
    for (std::size_t at = 0; at < cells->count; at += ACDF_WIDTH)
        stored(&cells->tile[at], loaded(&cells->tile[at]) & 0x7FFF);
}

/* Squares and tiles of up to kBlock lanes. Returns those that floats cannot decide. */
ACDF_LANE std::uint64_t find_all_squares(const AcdfLocal& local, const float (*directions)[3], std::size_t count,
                                         Cells* cells) {
    std::uint64_t lost = 0;
    for (std::size_t first = 0; first < count; first += kLanes) {
        const std::size_t more = std::min(count - first, kLanes);
        float last[kLanes][3] = {};
        if (more < kLanes) std::memcpy(last, directions + first, more * sizeof *directions);
        const std::uint32_t refused = find_squares(local, more < kLanes ? last : directions + first, first, cells);
        lost |= (std::uint64_t)(refused & ((1u << more) - 1u)) << first;
    }
    find_tiles(*local.tables, cells);
    return lost;
}

// ---- probabilities ---------------------------------------------------------------------------------------------

/// Points of lanes.
struct Seen : LightLanes {
    alignas(64) double weight[kRows][kRoom];
    alignas(64) long long row[kRows][kRoom];
};

ACDF_LANE void keep(const Points<false>& p, std::size_t at, Seen* seen) {
    for (int i = 0; i < kRows; ++i) {
        stored(&seen->weight[i][at], p.weight[i]);
        stored(&seen->row[i][at], p.codes[i]);
    }
    keep_lights(p, at, seen);
}

ACDF_LANE void end_points(const AcdfLocal& local, Seen* seen) {
    add_other_lights(local, seen, [](const long long*, Integer, Vector, Vector) {});
}

/* What the mixture gives to the tile of a lane: acdf_tile_share_rows. */
ACDF_LANE double share_of(const AcdfLocalTables& tables, const Seen& seen, std::size_t i, std::uint32_t tile) {
    AcdfMixture mix;
    const std::uint8_t* row[kRows];
    for (int k = 0; k < kRows; ++k) {
        mix.weight[k] = seen.weight[k][i];
        row[k] = (const std::uint8_t*)seen.row[k][i];
    }
    return acdf_tile_share_rows(acdf_local_words(&tables), &tables.tiles, &mix, row, kRows,
                                acdf_local_tile(&tables, tile), 0);
}

/* Asks for the bytes of rows on the way to a lane's tile, in the middle and at its end. */
ACDF_LANE void ask_for_rows(const AcdfLocalTables& tables, const Seen& seen, const Cells& cells, std::size_t i) {
    const AcdfTileRecord* const tile = acdf_local_tile(&tables, (std::uint32_t)cells.tile[i]);
    if (tile->depth > ACDF_TILE_STEPS) return;
    const std::size_t middle = tile->step[tile->depth / 2] >> 1, last = tile->step[tile->depth - 1] >> 1;
    for (int k = 0; k < kRows; ++k) {
        ACDF_PREFETCH((const std::uint8_t*)seen.row[k][i]);
        ACDF_PREFETCH((const std::uint8_t*)seen.row[k][i] + middle);
        ACDF_PREFETCH((const std::uint8_t*)seen.row[k][i] + last);
    }
}

/* Of a tile to which the mixture gives nothing: that of its light. */
__attribute__((noinline)) double light_probability(const AcdfLocal& local, const Seen& seen, std::size_t i,
                                                   std::uint32_t tile) {
    const std::uint32_t light = acdf_local_bright_tile_of(&local, tile);
    if (light == 0) return 0.0;
    AcdfScaledNormal at;
    for (int k = 0; k < 3; ++k) at.normal[k] = seen.normal[k][i];
    at.length = seen.length[i];
    const double probability = acdf_bright_tile_weight(&local.bright_tiles[light - 1], &at) / seen.sum[i];
    return probability > 0.0 ? acdf_positive(probability) : 0.0;
}

/* acdf_local_tile_probability of some tiles, by what the mixture gives to them. */
ACDF_LANE void weigh_tiles(const AcdfLocal& local, const Seen& seen, const long long* tile, const double* given,
                           std::size_t count, double* probability) {
    for (std::size_t at = 0; at < count; at += ACDF_WIDTH) {
        const Vector mixture = loaded(&seen.mixture[at]), share = loaded(&given[at]);
        stored(&probability[at], positive(mixture / loaded(&seen.sum[at]) * positive(share / mixture)));
        const std::size_t more = std::min<std::size_t>(count - at, ACDF_WIDTH);
        unsigned none = ~lanes(less(all(0.0), share)) & ((1u << more) - 1u);
        for (; none; none &= none - 1) {
            const std::size_t i = at + acdf_lowest_bit(none);
            probability[i] = light_probability(local, seen, i, (std::uint32_t)tile[i]);
        }
    }
}

/* acdf_local_cell_pdf of kLanes cells. */
ACDF_LANE Floats cell_pdfs(const AcdfLocal& local, const Cells& cells, const Boxes& done, std::size_t first) {
    Vector out[2];
    for (std::size_t half = 0; half < 2; ++half) {
        const std::size_t at = first + ACDF_WIDTH * half;
        const Integer low = loaded(&done.low[1][at]), high = loaded(&done.high[1][at]);
        const Vector width = converted(loaded(&done.high[0][at])) - converted(loaded(&done.low[0][at]));
        const Vector given = loaded(&cells.probability[at]);
        const Mask some = both(less(all(0.0), given), less(all(0.0), loaded(&done.product[at])));
        const double* const z = acdf_local_heights(local.tables);
        const Vector area = local.tables->octahedral
                                ? fold_area(width, converted(high) - converted(low), local.environment.rows)
                                : row_area(width, (Vector)loaded_from(z, low), (Vector)loaded_from(z, high));
        out[half] =
            choose(some, area_pdf(probabilities(cells, done, at), local.environment.columns, area), all(0.0));
    }
    return to_floats((Doubles)out[0], (Doubles)out[1]);
}

/* Pdfs of all cells. Returns the lanes that are left to single calls. */
ACDF_LANE std::uint64_t pdfs_of(const AcdfLocal& local, const Cells& cells, const Boxes& done, float* out) {
    std::uint64_t lost = 0;
    for (std::size_t first = 0; first < cells.count; first += kLanes) {
        alignas(64) float pdfs[kLanes];
        *(Floats*)pdfs = cell_pdfs(local, cells, done, first);
        for (std::size_t i = 0; i < kLanes && first + i < cells.count; ++i) {
            out[first + i] = pdfs[i];
            lost |= (std::uint64_t)done.lost[first + i] << (first + i);
        }
    }
    return lost;
}

constexpr std::size_t kAhead = 8; // lanes, whose rows are asked for

/* Pdfs of up to kBlock lanes; `at` and `alone` as in draw_block. */
template <class At, class Alone>
ACDF_LANE void pdf_block(const AcdfLocal& local, const At& at, const Alone& alone, const float (*directions)[3],
                         std::size_t count, float* out) {
    Seen seen;
    Cells cells;
    Boxes done;
    alignas(64) double given[kRoom];
    std::uint64_t lost = 0;
    cells.count = count;
    at(count, count, [&](const Points<false>& p, std::size_t first) {
        keep(p, first, &seen);
        lost |= not_served(p, first);
    });
    end_points(local, &seen);
    lost |= find_all_squares(local, directions, count, &cells);
    ask_for_curves(local, cells);
    for (std::size_t i = 0; i < count; ++i) {
        if (i + kAhead < count) ask_for_rows(*local.tables, seen, cells, i + kAhead);
        given[i] = share_of(*local.tables, seen, i, (std::uint32_t)cells.tile[i]);
    }
    weigh_tiles(local, seen, cells.tile, given, count, cells.probability);
    find_cells<true>(local, cells, &done);
    lost |= pdfs_of(local, cells, done, out);
    leave_alone(lost, count, alone);
}

} // namespace
