// Samples from cuts (acdf/product/cut_sample.h) over vectors, operation by operation: the way to a part and its
// bright tiles here, tiles and directions as LocalBatch samples them. Internal linkage: see local_kernel.h.
#pragma once

#include "batch/local_kernel.h"
#include "product/vectors/alone.h"

#include <acdf/product/cut_batch.h>

#include <cstddef>

namespace {

/// What lanes have sampled of parts.
struct DrawnParts {
    alignas(64) double u[2][kRoom];
    alignas(64) long long part[kRoom];
};

/// A mixture that is traversed is a part's.
struct CutWalks : Walks {
    alignas(64) double probability[kRoom];
};

// ---- parts -----------------------------------------------------------------------------------------------------

/* Two doubles of each lane's element of an array, from a position in it on. */
template <class T>
ACDF_LANE void pairs_of(const T* array, Integer number, std::size_t place, Vector out[2]) {
    const double* from[ACDF_WIDTH];
    pointers_of(number * (long long)sizeof(T) + (long long)((std::uintptr_t)array + place), from);
    gather_pairs(from, out);
}

/* acdf_cut_choose_part of some lanes. */
ACDF_LANE void find_parts(const AcdfCut& cut, const double (*given)[2], std::size_t count, DrawnParts* sampled) {
    double u[ACDF_CUT_BATCH][2];
    int guess[ACDF_CUT_BATCH];
    for (std::size_t i = 0; i < count; ++i) {
        for (int axis = 0; axis < 2; ++axis) u[i][axis] = acdf_cut_number(given[i][axis]);
        guess[i] = acdf_cut_guess(&cut, u[i], 0);
        acdf_cut_part_ahead(&cut, guess[i]);
    }
    for (std::size_t i = 0; i < count; ++i) {
        sampled->part[i] = acdf_cut_sample_guessed(&cut, guess[i], u[i]) - cut.part;
        for (int axis = 0; axis < 2; ++axis) sampled->u[axis][i] = u[i][axis];
    }
    for (std::size_t i = count; i % ACDF_WIDTH != 0; ++i) {
        sampled->part[i] = 0;
        for (auto& axis : sampled->u) axis[i] = 0.0;
    }
}

// ---- bright tiles and mixtures
// ---------------------------------------------------------------------------------------

/* acdf_cut_sample_bright_tile of the lanes of a mask, into cells. */
ACDF_LANE void draw_cut_lights(const AcdfLocal& local, const AcdfCut& cut, const DrawnParts& sampled,
                               std::size_t at, unsigned mask, Cells* cells) {
    for (; mask; mask &= mask - 1) {
        const std::size_t lane = at + acdf_lowest_bit(mask), to = cells->count++;
        double u[2] = {sampled.u[0][lane], sampled.u[1][lane]};
        AcdfRange range[2];
        cells->tile[to] = acdf_cut_sample_bright_tile(&local, &cut, &cut.part[sampled.part[lane]], u, range,
                                                      &cells->probability[to]);
        for (int axis = 0; axis < 2; ++axis) cells->u[axis][to] = u[axis];
        cells->lane[to] = (long long)lane;
    }
}

/* acdf_cut_samples_bright_tile, and what samples from a part's mixture begins its traversal. Returns the lanes that
 * neither does: those of mixtures without weight. */
ACDF_LANE unsigned enter_parts(const AcdfLocal& local, const AcdfLocalPoint& point, const AcdfCut& cut,
                               const DrawnParts& sampled, std::size_t at, unsigned there, CutWalks* walks,
                               Cells* cells) {
    const Integer part = loaded(&sampled.part[at]);
    Vector rows[2], last[2], sums[2], rest[2]; /* pairs of fields; some are of no interest */
    pairs_of(cut.part, part, offsetof(AcdfCutPart, weight), rows);
    pairs_of(cut.part, part, offsetof(AcdfCutPart, weight) + 16, last);
    pairs_of(cut.part, part, offsetof(AcdfCutPart, bright_tiles), sums);
    pairs_of(cut.part, part, offsetof(AcdfCutPart, probability), rest);
    static_assert(offsetof(AcdfCutPart, sum) == offsetof(AcdfCutPart, bright_tiles) + 8 &&
                  offsetof(AcdfCutPart, node) == offsetof(AcdfCutPart, probability) + 8 &&
                  offsetof(AcdfCutPart, entry) == offsetof(AcdfCutPart, node) + 2);
    const Vector u[2] = {loaded(&sampled.u[0][at]), loaded(&sampled.u[1][at])}, bright_tiles = sums[0],
                 sum = sums[1];
    const Vector of_lights = u[0] * sum, mixture = (rows[0] + rows[1]) + last[0];
    const Mask lit = both(less(all(0.0), bright_tiles),
                          either(less(of_lights, bright_tiles), without(all_lanes(), less(bright_tiles, sum))));
    const unsigned light = lanes(lit) & there, mixed = lanes(less(all(0.0), mixture)) & (there ^ light);
    const Vector own = unit_interval((of_lights - bright_tiles) / (sum - bright_tiles));
    const std::size_t to = walks->count;
    for (int i = 0; i < kRows; ++i)
        store_packed(&walks->weight[i][to], i == 0 ? rows[0] : i == 1 ? rows[1] : last[0], mixed);
    store_packed(&walks->x[0][to], own * mixture, mixed);
    store_packed(&walks->x[1][to], u[1] * mixture, mixed);
    store_packed(&walks->mixture[to], mixture, mixed);
    store_packed(&walks->sum[to], sum, mixed);
    store_packed(&walks->probability[to], rest[0], mixed);
    store_packed(&walks->node[to], (Integer)((Unsigned)(Integer)rest[1] >> 16) & 0xFFFF, mixed);
    store_packed(&walks->lane[to], numbers_from(at), mixed);
    walks->count += (std::size_t)__builtin_popcount(mixed);
    for (std::size_t i = to; i < walks->count; ++i)
        for (int k = 0; k < kRows; ++k) ACDF_PREFETCH(point.by.tabled.codes[k] + (walks->node[i] & 0x7FFF));
    draw_cut_lights(local, cut, sampled, at, light, cells);
    return there ^ light ^ mixed;
}

// ---- all of an array -------------------------------------------------------------------------------------------

/* acdf_cut_sample of up to ACDF_CUT_BATCH lanes. */
ACDF_LANE void draw_cut_block(const AcdfLocal& local, const AcdfLocalPoint& point, const AcdfCut& cut,
                              const double (*u)[2], std::size_t count, AcdfDirectionSample* out) {
    DrawnParts sampled;
    CutWalks walks;
    Cells cells;
    Boxes done;
    std::uint64_t lost = 0;
    walks.count = cells.count = 0;
    find_parts(cut, u, count, &sampled);
    for (std::size_t at = 0; at < count; at += ACDF_WIDTH) {
        const unsigned there = (1u << std::min<std::size_t>(count - at, ACDF_WIDTH)) - 1u;
        lost |= (std::uint64_t)enter_parts(local, point, cut, sampled, at, there, &walks, &cells) << at;
    }
    walk(*local.tables, SameRows{point.by.tabled.codes}, &walks);
    end_walks(
        local, walks, [&](std::size_t at, Vector of_all) { return loaded(&walks.probability[at]) * of_all; },
        &cells);
    find_cells<false>(local, cells, &done);
    lost |= place_cells(local, cells, done, out);
    for (; lost; lost &= lost - 1) {
        const auto lane = (std::size_t)__builtin_ctzll(lost);
        out[lane] = acdf::alone::cut_sample(local, point, cut, u[lane]);
    }
}

ACDF_LANE void draw_cut(const AcdfLocal& local, const AcdfLocalPoint& point, const AcdfCut& cut,
                        const double (*u)[2], std::size_t count, AcdfDirectionSample* out) {
    constexpr std::size_t batch = ACDF_CUT_BATCH;
    for (std::size_t first = 0; first < count; first += batch)
        draw_cut_block(local, point, cut, u + first, std::min(count - first, batch), out + first);
}

} // namespace
