/* Drawing from a cut, and its density (acdf/cut.h). One freestanding header, valid C99, C++17 and CUDA/HIP/SYCL. */
#ifndef ACDF_CUT_SAMPLE_H
#define ACDF_CUT_SAMPLE_H

#include <acdf/cut.h>

#ifdef __cplusplus
extern "C" {
#endif

/* Makes the cut ready to be drawn from: to be called when all parts have their probabilities, which need not add up
 * to 1. Parts without light get none. Where nothing is left the cut is emptied. */
ACDF_FN void acdf_cut_finish(AcdfCut* cut) {
    /* Of parts and splits, so that a child's number finds its own without a branch that nobody guesses: part ~n
     * stands before split 0, which is in the middle. */
    double shares[2 * ACDF_CUT_MAX_PARTS], *share = shares + ACDF_CUT_MAX_PARTS, sum = 0.0;
    int i;
    for (i = 0; i < cut->count; ++i) {
        const AcdfCutPart* part = &cut->part[i];
        sum += share[~i] = part->sum > 0.0 && part->probability > 0.0 ? part->probability : 0.0;
    }
    if (!(sum > 0.0) || !acdf_is_finite(sum)) {
        cut->count = 0;
        return;
    }
    for (i = 0; i < cut->count; ++i) cut->part[i].probability = share[~i] /= sum;
    for (i = cut->count - 2; i >= 0; --i) { /* a split's children stand behind it */
        AcdfCutSplit* split = &cut->split[i];
        const double lower = share[split->child[0]], whole = lower + share[split->child[1]];
        share[i] = whole;
        split->lower = whole > 0.0 ? lower / whole : 1.0;
    }
}

/* Number by number: of a mixture that is copied as a whole, and then given other weights, nvcc 13.0 sums the old
 * ones. */
ACDF_FN AcdfMixture acdf_cut_mixture(const AcdfLocalPoint* point, const AcdfCutPart* part) {
    AcdfMixture mix;
    int i;
    mix.count = point->mix.count;
    for (i = 0; i < ACDF_MAX_ROWS_MIXED; ++i) {
        mix.row[i] = point->mix.row[i];
        mix.weight[i] = i < mix.count ? part->weight[i] : 0.0;
    }
    return mix;
}

ACDF_FN void acdf_cut_range(const AcdfCutPart* part, AcdfRange range[2]) {
    int i;
    for (i = 0; i < 2; ++i) {
        range[i].low = part->low[i];
        range[i].high = part->high[i];
        range[i].tilt = 0.0;
    }
}

/* Draws a tile of a part from its mixture; *inside becomes its share of that. */
ACDF_FN uint32_t acdf_cut_sample_tile(const AcdfLocal* local, const AcdfLocalPoint* point, const AcdfCutPart* part,
                                      const AcdfMixture* mix, double* u, AcdfRange* range, double* inside) {
    if (acdf_local_tabled(local, point)) {
        const uint32_t* words = acdf_local_words(local->tables);
        const AcdfTileTables* tables = &local->tables->tiles;
        const double whole = acdf_mixture_sum(mix), from[2] = {u[0] * whole, u[1] * whole};
        const uint32_t tile = acdf_tile_draw(words, tables, mix, point->codes, part->entry, from, u, inside);
        acdf_tile_range(acdf_tile_record(words, tables, tile), range);
        *inside = acdf_positive(*inside / whole);
        return tile;
    }
    if (point->place.count > 0)
        return acdf_place_sample_below(&local->places, &local->blend, mix, &point->place, part->node, u, range,
                                       inside);
    return acdf_blend_sample_below(&local->blend, mix, part->node, u, range, inside);
}

/* Finds the tile of a square in a part, and its share of the part's mixture. */
ACDF_FN uint32_t acdf_cut_find_tile(const AcdfLocal* local, const AcdfLocalPoint* point, const AcdfCutPart* part,
                                    const AcdfMixture* mix, const uint32_t* square, AcdfRange* range,
                                    double* inside) {
    if (acdf_local_tabled(local, point)) {
        const uint32_t tile = acdf_tile_at(acdf_local_words(local->tables), &local->tables->tiles, square);
        *inside = acdf_local_found_tile(local, point, mix, tile, part->depth, range);
        return tile;
    }
    if (point->place.count > 0)
        return acdf_place_find_below(&local->places, &local->blend, mix, &point->place, part->node, square, range,
                                     inside);
    return acdf_blend_find_below(&local->blend, mix, part->node, square, range, 0, inside);
}

/* Draws a part: u becomes what is left of the random numbers. They are kept as what they are of the probability of
 * the box so far, as in acdf_blend_sample_rows: nothing is divided on the way. */
ACDF_FN const AcdfCutPart* acdf_cut_draw(const AcdfCut* cut, double u[2]) {
    int child = cut->count > 1 ? 0 : ~0, i;
    double chosen = 1.0;
    while (child >= 0) {
        const AcdfCutSplit* split = &cut->split[child];
        const uint32_t axis = split->place & 7u;
        const double lower = split->lower, low = chosen * lower;
        if (u[axis] < low || !(lower < 1.0)) {
            u[axis ^ 1u] *= lower;
            chosen = low;
            child = split->child[0];
        } else {
            u[axis] -= low;
            u[axis ^ 1u] *= 1.0 - lower;
            chosen -= low;
            child = split->child[1];
        }
    }
    for (i = 0; i < 2; ++i) u[i] = u[i] < chosen ? u[i] / chosen : 1.0;
    return &cut->part[~child];
}

/* Draws a cell of a part; u and range as in acdf_tree_sample. Returns its probability, > 0. */
ACDF_FN double acdf_cut_sample_part(const AcdfLocal* local, const AcdfLocalPoint* point, const AcdfCut* cut,
                                    const AcdfCutPart* part, double* u, AcdfRange* range) {
    double x = u[0] * part->sum, probability = part->probability;
    uint32_t tile;
    if (part->lights > 0.0 && (x < part->lights || !(part->sum > part->lights))) {
        uint32_t k = part->first_light, chosen = part->end_light;
        double weight = 0.0;
        for (; k < part->end_light; ++k) {
            if (!(cut->light[k] > 0.0)) continue;
            if (chosen < part->end_light) x -= weight;
            chosen = k;
            weight = cut->light[k];
            if (x < weight) break;
        }
        u[0] = acdf_unit_interval(x / weight);
        tile = local->lights[chosen].tile;
        for (k = 0; k < 2; ++k) {
            range[k].low = local->lights[chosen].low[k];
            range[k].high = local->lights[chosen].high[k];
        }
        probability = acdf_positive(probability * (weight / part->sum));
    } else {
        const AcdfMixture mix = acdf_cut_mixture(point, part);
        double inside;
        u[0] = acdf_unit_interval((x - part->lights) / (part->sum - part->lights));
        tile = acdf_cut_sample_tile(local, point, part, &mix, u, range, &inside);
        probability = acdf_positive(probability * (acdf_mixture_sum(&mix) / part->sum * inside));
    }
    return acdf_local_draw_inside(local, tile, probability, u, range);
}

/* Finds the cell of a grid square in a part. Returns its probability, 0 where no sample can fall. */
ACDF_FN double acdf_cut_find_part(const AcdfLocal* local, const AcdfLocalPoint* point, const AcdfCut* cut,
                                  const AcdfCutPart* part, const uint32_t* square, AcdfRange* range) {
    const AcdfMixture mix = acdf_cut_mixture(point, part);
    double probability;
    uint32_t light = part->first_light;
    const uint32_t tile = acdf_cut_find_tile(local, point, part, &mix, square, range, &probability);
    if (probability > 0.0) {
        probability = acdf_positive(part->probability * (acdf_mixture_sum(&mix) / part->sum * probability));
    } else { /* no row gives a light any probability */
        while (light < part->end_light && local->lights[light].tile < tile) ++light;
        if (light == part->end_light || local->lights[light].tile != tile || !(cut->light[light] > 0.0)) return 0.0;
        probability = acdf_positive(part->probability * (cut->light[light] / part->sum));
    }
    return acdf_local_find_inside(local, tile, probability, square, range);
}

/* Density per steradian with which acdf_cut_sample draws `direction` (unit); of cuts that are finished. */
ACDF_CALLED float acdf_cut_pdf(const AcdfLocal* local, const AcdfLocalPoint* point, const AcdfCut* cut,
                               const float direction[3]) {
    const AcdfGrid grid = acdf_environment_grid(&local->environment);
    AcdfRange range[2];
    double p;
    uint32_t square[2];
    const AcdfCutPart* part;
    int child = cut->count > 1 ? 0 : ~0;
    if (cut->count == 0 || !acdf_local_square(&grid, direction, square)) return 0.0f;
    while (child >= 0) {
        const AcdfCutSplit* split = &cut->split[child];
        child = split->child[square[split->place & 7u] >= split->place >> 3];
    }
    part = &cut->part[~child];
    if (!(part->probability > 0.0)) return 0.0f;
    acdf_cut_range(part, range);
    p = acdf_cut_find_part(local, point, cut, part, square, range);
    return p > 0.0 ? acdf_local_cell_pdf(local, &grid, direction, range, p) : 0.0f;
}

/* Draws a direction; u0 (axis 0) and u1 (axis 1) in [0, 1]; values outside are clamped, NaN counts as 0. pdf 0 (and
 * no direction) where the cut is empty. */
ACDF_CALLED AcdfDirectionSample acdf_cut_sample(const AcdfLocal* local, const AcdfLocalPoint* point,
                                                const AcdfCut* cut, double u0, double u1) {
    const AcdfGrid grid = acdf_environment_grid(&local->environment);
    AcdfDirectionSample out = {{0.0f, 0.0f, 0.0f}, 0.0f};
    const AcdfCutPart* part;
    AcdfRange range[2];
    double u[2], p;
    if (cut->count == 0) return out;
    u[0] = acdf_unit_interval(u0);
    u[1] = acdf_unit_interval(u1);
    part = acdf_cut_draw(cut, u);
    acdf_cut_range(part, range);
    p = acdf_cut_sample_part(local, point, cut, part, u, range);
    out = acdf_local_place(local, point, &grid, range, u, p);
    /* A slope makes the density depend on where the rounded direction lies. */
    if (range[0].tilt != 0.0 || range[1].tilt != 0.0) out.pdf = acdf_cut_pdf(local, point, cut, out.direction);
    return out;
}

#ifdef __cplusplus
}
#endif
#endif
