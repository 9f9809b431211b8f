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
    double whole[ACDF_CUT_MAX_PARTS], sum = 0.0;
    int i, k;
    for (i = 0; i < cut->count; ++i) {
        AcdfCutPart* part = &cut->part[i];
        if (!(part->sum > 0.0) || !(part->probability > 0.0)) part->probability = 0.0;
        sum += part->probability;
    }
    if (!(sum > 0.0) || !acdf_is_finite(sum)) {
        cut->count = 0;
        return;
    }
    for (i = 0; i < cut->count; ++i) cut->part[i].probability /= sum;
    for (i = cut->count - 2; i >= 0; --i) { /* a split's children stand behind it */
        double half[2];
        for (k = 0; k < 2; ++k) {
            const int child = cut->split[i].child[k];
            half[k] = child < 0 ? cut->part[~child].probability : whole[child];
        }
        whole[i] = half[0] + half[1];
        cut->split[i].lower = whole[i] > 0.0 ? half[0] / whole[i] : 1.0;
    }
}

ACDF_FN AcdfMixture acdf_cut_mixture(const AcdfLocalPoint* point, const AcdfCutPart* part) {
    AcdfMixture mix = point->mix;
    int i;
    for (i = 0; i < mix.count; ++i) mix.weight[i] = part->weight[i];
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

ACDF_FN uint32_t acdf_cut_root(const AcdfLocal* local, uint32_t tile) {
    return local->blend.roots ? local->blend.roots[tile] : ACDF_NO_ROOT;
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
    uint32_t tile, root;
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
        tile = point->place.count > 0 ? acdf_place_sample_below(&local->places, &local->blend, &mix, &point->place,
                                                                part->node, u, range, &inside)
                                      : acdf_blend_sample_below(&local->blend, &mix, part->node, u, range, &inside);
        probability = acdf_positive(probability * (acdf_mixture_sum(&mix) / part->sum * inside));
    }
    root = acdf_cut_root(local, tile);
    if (root == ACDF_NO_ROOT) return probability;
    return acdf_positive(probability *
                         acdf_tree_draw(local->blend.tree, local->environment.tree_units, root, u, range));
}

/* Finds the cell of a grid square in a part. Returns its probability, 0 where no sample can fall. */
ACDF_FN double acdf_cut_find_part(const AcdfLocal* local, const AcdfLocalPoint* point, const AcdfCut* cut,
                                  const AcdfCutPart* part, const uint32_t* square, AcdfRange* range) {
    const AcdfMixture mix = acdf_cut_mixture(point, part);
    double probability, inside;
    uint32_t light = part->first_light, root;
    const uint32_t tile =
        point->place.count > 0
            ? acdf_place_find_below(&local->places, &local->blend, &mix, &point->place, part->node, square, range,
                                    &probability)
            : acdf_blend_find_below(&local->blend, &mix, part->node, square, range, 0, &probability);
    if (probability > 0.0) {
        probability = acdf_positive(part->probability * (acdf_mixture_sum(&mix) / part->sum * probability));
    } else { /* no row gives a light any probability */
        while (light < part->end_light && local->lights[light].tile < tile) ++light;
        if (light == part->end_light || local->lights[light].tile != tile || !(cut->light[light] > 0.0)) return 0.0;
        probability = acdf_positive(part->probability * (cut->light[light] / part->sum));
    }
    root = acdf_cut_root(local, tile);
    if (root == ACDF_NO_ROOT) return probability;
    inside = acdf_tree_locate(local->blend.tree, local->environment.tree_units, root, square, range);
    return inside > 0.0 ? acdf_positive(probability * inside) : 0.0;
}

/* Density per steradian with which acdf_cut_sample draws `direction` (unit); of cuts that are finished. */
ACDF_FN float acdf_cut_pdf(const AcdfLocal* local, const AcdfLocalPoint* point, const AcdfCut* cut,
                           const float direction[3]) {
    const AcdfGrid grid = acdf_environment_grid(&local->environment);
    AcdfRange range[2];
    double t[2] = {0.5, 0.5}, position[2], p;
    uint32_t square[2];
    const AcdfCutPart* part;
    int child = cut->count > 1 ? 0 : ~0;
    if (cut->count == 0 || !acdf_grid_square(&grid, direction, square, position)) return 0.0f;
    while (child >= 0) {
        const AcdfCutSplit* split = &cut->split[child];
        child = split->child[square[split->place & 7u] >= split->place >> 3];
    }
    part = &cut->part[~child];
    if (!(part->probability > 0.0)) return 0.0f;
    acdf_cut_range(part, range);
    p = acdf_cut_find_part(local, point, cut, part, square, range);
    if (!(p > 0.0)) return 0.0f;
    if (range[0].tilt != 0.0 || range[1].tilt != 0.0) acdf_grid_fractions(&grid, direction, position, range, t);
    return acdf_grid_pdf(&grid, range, t, p);
}

/* Draws a direction; u0 (axis 0) and u1 (axis 1) in [0, 1]; values outside are clamped, NaN counts as 0. pdf 0 (and
 * no direction) where the cut is empty. */
ACDF_FN AcdfDirectionSample acdf_cut_sample(const AcdfLocal* local, const AcdfLocalPoint* point, const AcdfCut* cut,
                                            double u0, double u1) {
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
    out = acdf_grid_place(&grid, range, u, p);
    /* A slope makes the density depend on where the rounded direction lies. */
    if (range[0].tilt != 0.0 || range[1].tilt != 0.0) out.pdf = acdf_cut_pdf(local, point, cut, out.direction);
    return out;
}

#ifdef __cplusplus
}
#endif
#endif
