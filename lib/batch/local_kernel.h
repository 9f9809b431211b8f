// Samples of LocalBatch over vectors of ACDF_WIDTH doubles, by the extensions of GCC and Clang. Included by one
// source a set of instructions, compiled for it; nothing here may be inline with external linkage, lest the linker
// picks code that the processor does not have.
//
// Each function is that of the same name in acdf/tile_tables.h, acdf/local.h and acdf/row_heights.h, a lane an
// element, operation by operation: results agree bit for bit. Lanes are those of a block that sample from the
// mixture, one after the other, and then those that sample a bright tile. Normals on edges of triangles and samples
// next to borders are left to the functions of acdf/local.h.
#pragma once

#include "batch/local.h"
#include "batch/local_blocks_kernel.h"
#include "batch/local_curve_vectors.h"
#include "batch/row_vectors.h"

#include <algorithm>
#include <cstring>

namespace {

/// Lanes on their way through the splits.
struct Walks {
    std::size_t count;
    alignas(64) double weight[kRows][kRoom], part[kRows][kRoom], x[2][kRoom], chosen[kRoom];
    alignas(64) double whole[kRows][kRoom], mixture[kRoom], sum[kRoom]; // of their points
    alignas(64) long long row[kRows][kRoom], node[kRoom], lane[kRoom];
};

// ---- numbers ---------------------------------------------------------------------------------------------------

/* acdf_local_sample_bright_tile of the lanes of a mask, into cells; of tiles the numbers of the bright tiles. */
ACDF_LANE void draw_lights(const AcdfLocal& local, const Points<true>& p, const Vector u[2], unsigned mask,
                           Integer lane, Cells* cells) {
    Vector x = u[0] * p.sum, weight = all(0.0), number = all(0.0);
    Mask active = all_lanes();
    for (std::uint32_t k = 0; k < local.bright_tile_count;) {
        for (std::uint32_t end = std::min(k + 8, local.bright_tile_count); k < end; ++k) {
            const Mask taken = both(active, less(all(0.0), p.light[k]));
            x = choose(taken, x - weight, x);
            weight = choose(taken, p.light[k], weight);
            number = choose(taken, all((double)k), number);
            active = without(active, both(taken, less(x, weight)));
        }
        if ((lanes(active) & mask) == 0) break;
    }
    const std::size_t at = cells->count;
    store_packed(&cells->u[0][at], unit_interval(x / weight), mask);
    store_packed(&cells->u[1][at], u[1], mask);
    store_packed(&cells->probability[at], positive(weight / p.sum), mask);
    store_packed(&cells->lane[at], lane, mask);
    store_packed(&cells->tile[at], truncated(number), mask);
    cells->count += (std::size_t)__builtin_popcount(mask);
}

/// Where the codes of lanes are: in rows of each lane's own, and in those of one point.
struct OwnRows {
    ACDF_LANE_MEMBER void keep(const Points<true>& p, unsigned mask, Walks* walks) const {
        const std::size_t at = walks->count;
        for (int i = 0; i < kRows; ++i) store_packed(&walks->row[i][at], p.codes[i], mask);
        for (std::size_t k = at; k < at + (std::size_t)__builtin_popcount(mask); ++k)
            for (const auto& row : walks->row) ACDF_PREFETCH((const std::uint8_t*)row[k]);
    }
    ACDF_LANE_MEMBER void end(Walks* walks, std::size_t room) const {
        for (auto& row : walks->row) std::fill(row + walks->count, row + room, row[0]);
    }
    ACDF_LANE_MEMBER void bytes(const Walks& walks, std::size_t at, Integer place,
                                const std::uint8_t* byte[kRows][ACDF_WIDTH]) const {
        for (int i = 0; i < kRows; ++i) pointers_of(loaded(&walks.row[i][at]) + place, byte[i]);
    }
};
struct SameRows {
    const std::uint8_t* const* row;
    ACDF_LANE_MEMBER void keep(const Points<true>&, unsigned, Walks*) const {}
    ACDF_LANE_MEMBER void end(Walks*, std::size_t) const {}
    ACDF_LANE_MEMBER void bytes(const Walks&, std::size_t, Integer place,
                                const std::uint8_t* byte[kRows][ACDF_WIDTH]) const {
        const std::uint8_t* number[ACDF_WIDTH];
        pointers_of(place, number);
        for (int i = 0; i < kRows; ++i)
            for (int k = 0; k < ACDF_WIDTH; ++k) byte[i][k] = row[i] + (std::uintptr_t)number[k];
    }
};

/* acdf_tile_walk_begin of the lanes of a mask, at split `root`. */
template <class Rows>
ACDF_LANE void begin_walks(const Points<true>& p, const Rows& rows, const Vector u[2], unsigned mask, Integer lane,
                           std::uint32_t root, Walks* walks) {
    const std::size_t at = walks->count;
    for (int i = 0; i < kRows; ++i) store_packed(&walks->weight[i][at], p.weight[i], mask);
    store_packed(&walks->x[0][at], u[0] * p.sum - p.bright_tiles, mask);
    store_packed(&walks->x[1][at], u[1] * p.mixture, mask);
    store_packed(&walks->mixture[at], p.mixture, mask);
    store_packed(&walks->sum[at], p.sum, mask);
    store_packed(&walks->node[at], Integer{} + root, mask);
    store_packed(&walks->lane[at], lane, mask);
    rows.keep(p, mask, walks);
    walks->count += (std::size_t)__builtin_popcount(mask);
}

// ---- splits ----------------------------------------------------------------------------------------------------

/* acdf_tile_walk_step of a vector. Returns whether any lane goes on. Lanes at a tile stay what they are. */
template <class Rows>
ACDF_LANE bool step(const double* codes, const AcdfSplit* splits, const Rows& rows, Walks* w, std::size_t at) {
    const Integer node = loaded(&w->node[at]), place = node & 0x7FFF, split = loaded_from(splits, place);
    const Mask ended = has(node, ACDF_TILE_FLAG), axis1 = has(split, 1);
    const std::uint8_t* byte[kRows][ACDF_WIDTH];
    Vector code[kRows][2], half[2], weight[kRows];
    rows.bytes(*w, at, place, byte);
    for (int i = 0; i < kRows; ++i) {
        const double* from[ACDF_WIDTH];
        for (int k = 0; k < ACDF_WIDTH; ++k) from[k] = codes + 2 * std::size_t{*byte[i][k]};
        gather_pairs(from, code[i]);
        weight[i] = loaded(&w->weight[i][at]);
    }
    for (int k = 0; k < 2; ++k)
        half[k] = (weight[0] * code[0][k] + weight[1] * code[1][k]) + weight[2] * code[2][k];
    const Vector x[2] = {loaded(&w->x[0][at]), loaded(&w->x[1][at])}, along = choose(axis1, x[1], x[0]);
    const Vector whole = loaded(&w->chosen[at]);
    const Mask upper = without(without(less(all(0.0), half[1]), less(along, half[0])), ended);
    const Vector taken = choose(ended, whole, choose(upper, half[1], half[0]));
    const Vector other = choose(axis1, x[0], x[1]) * (taken / whole);
    const Vector left = along - choose(upper, half[0], all(0.0));
    for (int i = 0; i < kRows; ++i) {
        const Vector given = choose(ended, all(1.0), choose(upper, code[i][1], code[i][0]));
        stored(&w->weight[i][at], weight[i] * given);
        stored(&w->part[i][at], loaded(&w->part[i][at]) * given);
    }
    stored(&w->x[0][at], choose(axis1, other, left));
    stored(&w->x[1][at], choose(axis1, left, other));
    stored(&w->chosen[at], taken);
    const Integer child = choose(upper, split >> 16, split) >> 32 & 0xFFFF, reached = choose(ended, node, child);
    stored(&w->node[at], reached);
    return lanes(has(reached, ACDF_TILE_FLAG)) + 1 != 1u << ACDF_WIDTH;
}

template <class Rows>
ACDF_LANE void walk(const AcdfLocalTables& tables, const Rows& rows, Walks* w) {
    const std::uint32_t* const words = acdf_local_words(&tables);
    const double* const codes = acdf_tile_codes(words, &tables.tiles);
    const AcdfSplit* const splits = acdf_tile_splits(words, &tables.tiles);
    std::size_t live[kRoom / ACDF_WIDTH], count = 0;
    for (std::size_t at = 0; at < w->count; at += ACDF_WIDTH) {
        for (int i = 0; i < kRows; ++i) {
            stored(&w->whole[i][at], loaded(&w->weight[i][at]));
            stored(&w->part[i][at], all(1.0));
        }
        stored(&w->chosen[at], loaded(&w->mixture[at]));
        live[count++] = at;
    }
    /* What stands behind the last lane is at a tile. */
    for (std::size_t i = w->count; i < count * ACDF_WIDTH; ++i) w->node[i] = ACDF_TILE_FLAG;
    rows.end(w, count * ACDF_WIDTH);
    while (count > 0) {
        std::size_t left = 0;
        for (std::size_t k = 0; k < count; ++k) {
            const std::size_t at = live[k];
            live[left] = at;
            left += step(codes, splits, rows, w, at);
        }
        count = left;
    }
}

/* acdf_tile_walk_end, acdf_local_sampled_tile and acdf_local_tile_probability of all lanes, into cells behind
 * others; `scaled(at, of_all)`: the probabilities of a vector of tiles that are such a part of all. */
template <class Scaled>
ACDF_LANE void end_walks(const AcdfLocal& local, const Walks& w, const Scaled& scaled, Cells* cells) {
    for (std::size_t i = 0; i < w.count; ++i)
        ACDF_PREFETCH(acdf_local_tile(local.tables, (std::uint32_t)w.node[i] & ~ACDF_TILE_FLAG));
    for (std::size_t at = 0, to = cells->count; at < w.count; at += ACDF_WIDTH, to += ACDF_WIDTH) {
        const Vector chosen = loaded(&w.chosen[at]), mixture = loaded(&w.mixture[at]);
        for (int k = 0; k < 2; ++k) {
            const Vector x = loaded(&w.x[k][at]), left = x / chosen;
            stored(&cells->u[k][to], select(x < chosen, select(left > 0.0, left, all(0.0)), all(1.0)));
        }
        Vector given = all(0.0);
        for (int i = 0; i < kRows; ++i) given += loaded(&w.whole[i][at]) * loaded(&w.part[i][at]);
        const Vector of_all = mixture / loaded(&w.sum[at]) * positive(given / mixture);
        stored(&cells->probability[to], positive(scaled(at, of_all)));
        stored(&cells->lane[to], loaded(&w.lane[at]));
        stored(&cells->tile[to], loaded(&w.node[at]) & ~(long long)ACDF_TILE_FLAG);
    }
    cells->count += w.count;
}

// ---- directions ------------------------------------------------------------------------------------------------

/* acdf_row_place of half of some lanes, in doubles. Returns the pdfs. */
ACDF_LANE Vector row_place(const AcdfLocal& local, const Cells& cells, const Boxes& done, std::size_t at, int half,
                           Drawn* out) {
    const double columns = local.environment.columns;
    const double* const z = acdf_local_heights(local.tables);
    const Vector low = converted(loaded(&done.low[0][at])), high = converted(loaded(&done.high[0][at]));
    const Vector z0 = (Vector)loaded_from(z, loaded(&done.low[1][at])),
                 z1 = (Vector)loaded_from(z, loaded(&done.high[1][at]));
    const Vector u[2] = {loaded(&done.u[0][at]), loaded(&done.u[1][at])};
    row_direction(columns, low, high, z0, z1, u, half, out);
    return area_pdf(probabilities(cells, done, at), columns, row_area(high - low, z0, z1));
}

/* acdf_fold_place of the same. */
ACDF_LANE Vector fold_place(const AcdfLocal& local, const Cells& cells, const Boxes& done, std::size_t at, int half,
                            Drawn* out) {
    const double columns = local.environment.columns, rows = local.environment.rows;
    Vector low[2], width[2], u[2];
    for (int axis = 0; axis < 2; ++axis) {
        low[axis] = converted(loaded(&done.low[axis][at]));
        width[axis] = converted(loaded(&done.high[axis][at])) - low[axis];
        u[axis] = loaded(&done.u[axis][at]);
    }
    fold_direction(columns, rows, low, width, u, half, out);
    return area_pdf(probabilities(cells, done, at), columns, fold_area(width[0], width[1], rows));
}

/* acdf_local_direction_sample of all cells. Returns the lanes that are not answered. */
ACDF_LANE std::uint64_t place_cells(const AcdfLocal& local, const Cells& cells, const Boxes& done,
                                    AcdfDirectionSample* out) {
    std::uint64_t lost = 0;
    for (std::size_t first = 0; first < done.count; first += kLanes) {
        Drawn d;
        Vector pdf[2];
        Floats direction[3];
        AcdfDirectionSample drawn[kLanes];
        for (int half = 0; half < 2; ++half) {
            const std::size_t at = first + ACDF_WIDTH * (std::size_t)half;
            pdf[half] = local.tables->octahedral ? fold_place(local, cells, done, at, half, &d)
                                                 : row_place(local, cells, done, at, half, &d);
        }
        const std::uint32_t refused = sampled_directions(local.tables->octahedral != 0, d, direction);
        store_samples(direction, to_floats((Doubles)pdf[0], (Doubles)pdf[1]), drawn);
        for (std::size_t i = 0; i < kLanes && first + i < done.count; ++i) {
            const std::size_t lane = (std::size_t)cells.lane[first + i];
            out[lane] = drawn[i];
            lost |= (std::uint64_t)((refused >> i & 1u) | (std::uint32_t)done.lost[first + i]) << lane;
        }
    }
    return lost;
}

// ---- all of an array -------------------------------------------------------------------------------------------

/* Samples of up to kBlock lanes; `at` as PointsOf; `alone(lane)` samples singly. */
template <class Rows, class At, class Alone>
ACDF_LANE void draw_block(const AcdfLocal& local, const Rows& rows, const At& at, const Alone& alone,
                          const double (*u)[2], std::size_t count, AcdfDirectionSample* out) {
    Walks walks;
    Cells cells;
    Boxes done;
    std::uint64_t lost = 0;
    walks.count = cells.count = 0;
    at(count, count, [&](const Points<true>& p, std::size_t first) {
        const std::size_t more = lanes_there(first, count);
        const unsigned there = (1u << more) - 1u;
        const Integer lane = numbers_from(first);
        Vector v[2];
        numbers_of(u + first, more, v);
        const unsigned served = bits(p.served) & there,
                       light = bits((Integer)(v[0] * p.sum < p.bright_tiles)) & served;
        lost |= (std::uint64_t)(served ^ there) << first;
        begin_walks(p, rows, v, served ^ light, lane, local.tables->tiles.root, &walks);
        if (light) draw_lights(local, p, v, light, lane, &cells);
    });
    for (std::size_t i = 0; i < cells.count; ++i) {
        cells.tile[i] = local.bright_tiles[cells.tile[i]].tile;
        ACDF_PREFETCH(acdf_local_tile(local.tables, (std::uint32_t)cells.tile[i]));
    }
    walk(*local.tables, rows, &walks);
    end_walks(
        local, walks, [](std::size_t, Vector of_all) { return of_all; }, &cells);
    find_cells<false>(local, cells, &done);
    lost |= place_cells(local, cells, done, out);
    leave_alone(lost, count, alone);
}

ACDF_LANE OwnRows rows_of(const float (*)[3]) { return {}; }
ACDF_LANE SameRows rows_of(const AcdfLocalPoint& point) { return {point.by.tabled.codes}; }

/* `of`: normals, one each, or the point of all. */
template <class Of>
ACDF_LANE void sample_all(const AcdfLocal& local, Of of, const double (*u)[2], std::size_t count,
                          AcdfDirectionSample* out) {
    draws_in_blocks<Points<true>>(local, of, u, count, out,
                                  [&](const auto&... rest) { draw_block(local, rows_of(of), rest...); });
}

} // namespace
