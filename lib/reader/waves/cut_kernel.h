// Draws from cuts (acdf/cut_sample.h) over vectors, operation by operation: the way to a part and its lights here,
// tiles and directions as LocalWavefront draws them. Internal linkage: see local_kernel.h.
#pragma once

#include "waves/local_kernel.h"

#include <acdf/cut_wave.h>

#include <cstddef>

namespace {

/// Lanes on their way to parts. Nodes: splits of the cut, or complements of parts in 16 bits.
struct Ways {
    alignas(64) double u[2][kRoom], bound[2][2][kRoom]; // bound: AcdfCutNumbers
    alignas(64) long long node[kRoom];
};

constexpr long long kPart = 0x8000; // the bit that all complements have

/// A mixture that is walked is a part's.
struct CutWalks : Walks {
    alignas(64) double probability[kRoom];
};

// ---- parts -----------------------------------------------------------------------------------------------------

/* Two doubles of each lane's element of an array, from a place in it on. */
template <class T>
ACDF_LANE void pairs_of(const T* array, Integer number, std::size_t place, Vector out[2]) {
    const double* from[ACDF_WIDTH];
    pointers_of(number * (long long)sizeof(T) + (long long)((std::uintptr_t)array + place), from);
    gather_pairs(from, out);
}

/* acdf_cut_number */
ACDF_LANE Vector cut_number(Vector u) {
    const Vector x = unit_interval(u), most = all(1.0 - 0x1p-53);
    return select(x < most, x, most);
}

/* acdf_cut_step of a vector. Returns whether any lane goes on. */
ACDF_LANE bool cut_step(const AcdfCut& cut, Ways* ways, std::size_t at) {
    static_assert(offsetof(AcdfCutSplit, child) == 4 && offsetof(AcdfCutSplit, border) == 8);
    Vector pair[2];
    const Integer node = loaded(&ways->node[at]);
    const Mask ended = has(node, kPart);
    pairs_of(cut.split, choose(ended, Integer{}, node), 0, pair);
    const Integer split = (Integer)pair[0];
    const Vector border = pair[1];
    const Mask axis1 = has(split, 1), on[2] = {without(without(all_lanes(), ended), axis1), without(axis1, ended)};
    const Mask lower = less(choose(axis1, loaded(&ways->u[1][at]), loaded(&ways->u[0][at])), border);
    for (int axis = 0; axis < 2; ++axis) {
        double(&bound)[2][kRoom] = ways->bound[axis];
        stored(&bound[0][at], choose(without(on[axis], lower), border, loaded(&bound[0][at])));
        stored(&bound[1][at], choose(both(on[axis], lower), border, loaded(&bound[1][at])));
    }
    const Integer child = choose(lower, split, split >> 16) >> 32 & 0xFFFF, reached = choose(ended, node, child);
    stored(&ways->node[at], reached);
    return lanes(has(reached, kPart)) + 1 != 1u << ACDF_WIDTH;
}

/* acdf_cut_draw of some lanes, whose numbers are what is left of them then. */
ACDF_LANE void find_parts(const AcdfCut& cut, const double (*u)[2], std::size_t count, Ways* ways) {
    std::size_t live[kRoom / ACDF_WIDTH], going = 0;
    for (int i = 0; i + 1 < cut.count; i += 4) ACDF_PREFETCH(&cut.split[i]);
    for (std::size_t at = 0; at < count; at += ACDF_WIDTH) {
        const std::size_t more = std::min<std::size_t>(count - at, ACDF_WIDTH);
        double last[ACDF_WIDTH][2] = {};
        Doubles given[2];
        if (more < ACDF_WIDTH) std::memcpy(last, u + at, more * sizeof *u);
        load_pairs(more < ACDF_WIDTH ? last : u + at, given);
        for (int axis = 0; axis < 2; ++axis) {
            stored(&ways->u[axis][at], cut_number((Vector)given[axis]));
            stored(&ways->bound[axis][0][at], all(0.0));
            stored(&ways->bound[axis][1][at], all(1.0));
        }
        stored(&ways->node[at], Integer{} + (cut.count > 1 ? 0 : 0xFFFF));
        live[going] = at;
        going += cut.count > 1;
    }
    while (going > 0) {
        std::size_t left = 0;
        for (std::size_t k = 0; k < going; ++k) {
            const std::size_t at = live[k];
            live[left] = at;
            left += cut_step(cut, ways, at);
        }
        going = left;
    }
    for (std::size_t at = 0; at < count; at += ACDF_WIDTH) {
        const Integer part = loaded(&ways->node[at]) ^ 0xFFFF;
        stored(&ways->node[at], part);
        for (int axis = 0; axis < 2; ++axis) { /* acdf_cut_numbers_left */
            const Vector low = loaded(&ways->bound[axis][0][at]), width = loaded(&ways->bound[axis][1][at]) - low;
            const Vector x = loaded(&ways->u[axis][at]) - low;
            stored(&ways->u[axis][at], select(x < width, x / width, all(1.0)));
        }
    }
}

// ---- lights and mixtures ---------------------------------------------------------------------------------------

/* acdf_cut_draw_light of the lanes of a mask, into cells. */
ACDF_LANE void draw_cut_lights(const AcdfLocal& local, const AcdfCut& cut, const Ways& ways, std::size_t at,
                               unsigned mask, Cells* cells) {
    for (; mask; mask &= mask - 1) {
        const std::size_t lane = at + acdf_lowest_bit(mask), to = cells->count++;
        double u[2] = {ways.u[0][lane], ways.u[1][lane]};
        AcdfRange range[2];
        cells->tile[to] =
            acdf_cut_draw_light(&local, &cut, &cut.part[ways.node[lane]], u, range, &cells->probability[to]);
        for (int axis = 0; axis < 2; ++axis) cells->u[axis][to] = u[axis];
        cells->lane[to] = (long long)lane;
    }
}

/* acdf_cut_draws_light, and what draws from a part's mixture begins its walk. Returns the lanes that neither does:
 * those of mixtures without weight. */
ACDF_LANE unsigned enter_parts(const AcdfLocal& local, const AcdfLocalPoint& point, const AcdfCut& cut,
                               const Ways& ways, std::size_t at, unsigned there, CutWalks* walks, Cells* cells) {
    const Integer part = loaded(&ways.node[at]);
    Vector head[2], rows[2], last[2], sums[2], rest[2]; /* pairs of fields; some are of no interest */
    pairs_of(cut.part, part, 0, head);
    pairs_of(cut.part, part, offsetof(AcdfCutPart, weight), rows);
    pairs_of(cut.part, part, offsetof(AcdfCutPart, weight) + 16, last);
    pairs_of(cut.part, part, offsetof(AcdfCutPart, lights), sums);
    pairs_of(cut.part, part, offsetof(AcdfCutPart, sum), rest);
    static_assert(offsetof(AcdfCutPart, entry) == 2 &&
                  offsetof(AcdfCutPart, sum) == offsetof(AcdfCutPart, lights) + 8 &&
                  offsetof(AcdfCutPart, probability) == offsetof(AcdfCutPart, sum) + 8);
    const Vector u[2] = {loaded(&ways.u[0][at]), loaded(&ways.u[1][at])}, lights = sums[0], sum = sums[1];
    const Vector of_lights = u[0] * sum, mixture = (rows[0] + rows[1]) + last[0];
    const Mask lit =
        both(less(all(0.0), lights), either(less(of_lights, lights), without(all_lanes(), less(lights, sum))));
    const unsigned light = lanes(lit) & there, mixed = lanes(less(all(0.0), mixture)) & (there ^ light);
    const Vector own = unit_interval((of_lights - lights) / (sum - lights));
    const std::size_t to = walks->count;
    for (int i = 0; i < kRows; ++i)
        store_packed(&walks->weight[i][to], i == 0 ? rows[0] : i == 1 ? rows[1] : last[0], mixed);
    store_packed(&walks->x[0][to], own * mixture, mixed);
    store_packed(&walks->x[1][to], u[1] * mixture, mixed);
    store_packed(&walks->mixture[to], mixture, mixed);
    store_packed(&walks->sum[to], sum, mixed);
    store_packed(&walks->probability[to], rest[1], mixed);
    store_packed(&walks->node[to], (Integer)((Unsigned)(Integer)head[0] >> 16) & 0xFFFF, mixed);
    store_packed(&walks->lane[to], numbers_from(at), mixed);
    walks->count += (std::size_t)__builtin_popcount(mixed);
    for (std::size_t i = to; i < walks->count; ++i)
        for (int k = 0; k < kRows; ++k) ACDF_PREFETCH(point.codes[k] + (walks->node[i] & 0x7FFF));
    draw_cut_lights(local, cut, ways, at, light, cells);
    return there ^ light ^ mixed;
}

// ---- all of an array -------------------------------------------------------------------------------------------

/* acdf_cut_sample of up to ACDF_CUT_WAVE lanes. */
ACDF_LANE void draw_cut_block(const AcdfLocal& local, const AcdfLocalPoint& point, const AcdfCut& cut,
                              const double (*u)[2], std::size_t count, AcdfDirectionSample* out) {
    Ways ways;
    CutWalks walks;
    Cells cells;
    Boxes done;
    std::uint64_t lost = 0;
    walks.count = cells.count = 0;
    find_parts(cut, u, count, &ways);
    for (std::size_t i = 0; i < count; ++i) ACDF_PREFETCH(&cut.part[ways.node[i]].probability);
    for (std::size_t at = 0; at < count; at += ACDF_WIDTH) {
        const unsigned there = (1u << std::min<std::size_t>(count - at, ACDF_WIDTH)) - 1u;
        lost |= (std::uint64_t)enter_parts(local, point, cut, ways, at, there, &walks, &cells) << at;
    }
    walk(*local.tables, SameRows{point.codes}, &walks);
    end_walks(
        local, walks, [&](std::size_t at, Vector of_all) { return loaded(&walks.probability[at]) * of_all; },
        &cells);
    find_cells<false>(local, cells, &done);
    lost |= place_cells(local, cells, done, out);
    for (; lost; lost &= lost - 1) {
        const auto lane = (std::size_t)__builtin_ctzll(lost);
        out[lane] = acdf_cut_sample(&local, &point, &cut, u[lane][0], u[lane][1]);
    }
}

ACDF_LANE void draw_cut(const AcdfLocal& local, const AcdfLocalPoint& point, const AcdfCut& cut,
                        const double (*u)[2], std::size_t count, AcdfDirectionSample* out) {
    constexpr std::size_t wave = ACDF_CUT_WAVE;
    for (std::size_t first = 0; first < count; first += wave)
        draw_cut_block(local, point, cut, u + first, std::min(count - first, wave), out + first);
}

} // namespace
