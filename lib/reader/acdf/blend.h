/* Distributions that share their fine structure: one freestanding header over acdf/sample.h, valid C99, C++17 and
 * CUDA/HIP/SYCL, with the same contract (SPEC.md §9, §10).
 *
 * Boxes are split in two until tiles are left. Splits and tiles are stored once; each bin has a *row* of one byte a
 * split: the probability of its lower part. What a caller samples from is a *mixture* of up to four rows, traversed
 * side by side: its pdf is exactly the weighted sum of theirs, at the price of one more byte read a split and
 * row. Within a tile a tree of curves refines, for all bins alike. */
#ifndef ACDF_BLEND_H
#define ACDF_BLEND_H

#include <acdf/sample.h>
#include <acdf/short_curves.h>

#ifdef __cplusplus
extern "C" {
#endif

enum { ACDF_MAX_ROWS_MIXED = 4 };

typedef struct AcdfBlend {
    const AcdfTiles* tiles;  /* chunk TILE */
    const AcdfSplit* splits; /* tile_count - 1, behind it */
    const uint32_t* roots;   /* one a tile in `tree`; null where all tiles are cells */
    const uint8_t* rows;     /* chunk ROWS */
    const uint8_t* tree;     /* chunk TREE */
} AcdfBlend;

/* Rows and their weights, >= 0 and finite. */
typedef struct AcdfMixture {
    const uint8_t* row[ACDF_MAX_ROWS_MIXED];
    double weight[ACDF_MAX_ROWS_MIXED];
    int count;
} AcdfMixture;

ACDF_FN const uint8_t* acdf_blend_row(const AcdfBlend* blend, uint32_t index) {
    return blend->rows + (size_t)index * (blend->tiles->tile_count - 1);
}

/* Adds row `index` unless its weight is 0. */
ACDF_FN void acdf_mixture_add(AcdfMixture* mix, const AcdfBlend* blend, uint32_t index, double weight) {
    if (!(weight > 0.0)) return;
    mix->row[mix->count] = acdf_blend_row(blend, index);
    mix->weight[mix->count] = weight;
    ++mix->count;
}

ACDF_FN double acdf_mixture_sum(const AcdfMixture* mix) {
    double sum = 0.0;
    int i;
    for (i = 0; i < mix->count; ++i) sum += mix->weight[i];
    return sum;
}

/* What of each row's weight falls into the two parts of a split; sum[k] is their sum. */
ACDF_FN void acdf_mixture_split(const AcdfMixture* mix, const AcdfBlend* blend, uint32_t split, AcdfMixture out[2],
                                double sum[2]) {
    int i;
    sum[0] = sum[1] = 0.0;
    for (i = 0; i < mix->count; ++i) {
        const double code = (double)blend->tiles->codebook[mix->row[i][split]];
        sum[0] += out[0].weight[i] = mix->weight[i] * (code * (1.0 / 65535.0));
        sum[1] += out[1].weight[i] = mix->weight[i] * ((65535.0 - code) * (1.0 / 65535.0));
    }
}

ACDF_FN void acdf_range_cut(AcdfRange* range, uint32_t position, int upper) {
    if (upper) range->low = position;
    else range->high = position;
}

/* The traversals below are written for a number of rows that the compiler knows: weights then stay in registers. */

/* What a mixture gives to a tile to which each row gives that part of itself: in this order, so that tables of
 * parts give the same pdf. */
ACDF_INLINE double acdf_mixture_of(const AcdfMixture* mix, const int rows, const double* part) {
    double sum = 0.0;
    int i;
    for (i = 0; i < rows; ++i) sum += mix->weight[i] * part[i];
    return sum;
}

/* Random numbers are kept as what they are of the weight of the box so far, x = u * weight: a split only subtracts
 * from that of its axis, and the division that rescales the other one is not waited for. Which part comes next is
 * left to a branch: where it is guessed, the loads of the next split do not wait for this one's. */
ACDF_INLINE uint32_t acdf_blend_sample_rows(const AcdfBlend* blend, const AcdfMixture* mix, const int rows,
                                            uint32_t node, double* u, AcdfRange* range, double* probability) {
    const uint16_t* codebook = blend->tiles->codebook;
    const double whole = acdf_mixture_sum(mix);
    double weight[ACDF_MAX_ROWS_MIXED], part[ACDF_MAX_ROWS_MIXED], chosen = whole, x[2];
    int i;
    x[0] = u[0] * whole;
    x[1] = u[1] * whole;
    for (i = 0; i < rows; ++i) weight[i] = mix->weight[i];
    for (i = 0; i < rows; ++i) part[i] = 1.0;
    while (!(node & ACDF_TILE_FLAG)) {
        const AcdfSplit* split = &blend->splits[node];
        const uint32_t axis = split->place & 7u, position = split->place >> 3;
        double code[ACDF_MAX_ROWS_MIXED], lower[ACDF_MAX_ROWS_MIXED], low = 0.0, high = 0.0;
        for (i = 0; i < rows; ++i) {
            code[i] = (double)codebook[mix->row[i][node]];
            low += lower[i] = weight[i] * (code[i] * (1.0 / 65535.0));
            high += weight[i] - lower[i]; /* 65535.0 * (1.0 / 65535.0) is 1 */
        }
        if (!(x[axis] < low) && high > 0.0) {
            x[axis] -= low;
            x[axis ^ 1u] *= high / chosen;
            chosen = high;
            for (i = 0; i < rows; ++i) weight[i] -= lower[i];
            for (i = 0; i < rows; ++i) part[i] *= (65535.0 - code[i]) * (1.0 / 65535.0);
            range[axis].low = position;
            node = split->child[1];
        } else {
            x[axis ^ 1u] *= low / chosen;
            chosen = low;
            for (i = 0; i < rows; ++i) weight[i] = lower[i];
            for (i = 0; i < rows; ++i) part[i] *= code[i] * (1.0 / 65535.0);
            range[axis].high = position;
            node = split->child[0];
        }
    }
    for (i = 0; i < 2; ++i) u[i] = x[i] < chosen ? x[i] / chosen : 1.0;
    *probability = acdf_positive(acdf_mixture_of(mix, rows, part) / whole);
    return node & ~ACDF_TILE_FLAG;
}

/* Where a square lies does not depend on weights: the traversal is free of branches on the data, and the products
 * follow it. */
ACDF_INLINE uint32_t acdf_blend_find_rows(const AcdfBlend* blend, const AcdfMixture* mix, const int rows,
                                          uint32_t node, const uint32_t* square, AcdfRange* range,
                                          AcdfStratum* strata, double* probability) {
    const uint16_t* codebook = blend->tiles->codebook;
    const double whole = acdf_mixture_sum(mix);
    /* At or above every `place` of its axis and a position up to the square's. */
    const uint32_t key0 = square[0] << 3 | 7u, key1 = square[1] << 3 | 7u;
    double part[ACDF_MAX_ROWS_MIXED], chosen;
    uint32_t bound[2][2];
    int i;
    for (i = 0; i < 2; ++i) {
        bound[i][0] = range[i].high;
        bound[i][1] = range[i].low;
    }
    for (i = 0; i < rows; ++i) part[i] = 1.0;
    while (!(node & ACDF_TILE_FLAG)) {
        const AcdfSplit* split = &blend->splits[node];
        const uint32_t place = split->place, axis = place & 7u;
        const uint32_t first = key0 >= place, upper = first ^ ((first ^ (key1 >= place)) & axis);
        const uint32_t other = (0u - upper) & 0xFFFFu; /* 65535 - code is code ^ 65535 */
        if (strata) {
            double low = 0.0, high = 0.0, below;
            for (i = 0; i < rows; ++i) {
                const double code = (double)codebook[mix->row[i][node]];
                low += mix->weight[i] * (part[i] * (code * (1.0 / 65535.0)));
                high += mix->weight[i] * (part[i] * ((65535.0 - code) * (1.0 / 65535.0)));
            }
            below = low / (low + high);
            if (upper) strata[axis].low += strata[axis].width * below;
            strata[axis].width *= upper ? high / (low + high) : below;
        }
        for (i = 0; i < rows; ++i)
            part[i] *= (double)(int32_t)(codebook[mix->row[i][node]] ^ other) * (1.0 / 65535.0);
        bound[axis][upper] = place >> 3;
        node = split->child[upper];
    }
    for (i = 0; i < 2; ++i) {
        range[i].high = bound[i][0];
        range[i].low = bound[i][1];
    }
    chosen = acdf_mixture_of(mix, rows, part);
    *probability = chosen > 0.0 ? acdf_positive(chosen / whole) : 0.0;
    return node & ~ACDF_TILE_FLAG;
}

/* Where traversals begin: split 0, or the only tile. */
ACDF_FN uint32_t acdf_blend_root(const AcdfBlend* blend) {
    return blend->tiles->tile_count > 1 ? 0 : ACDF_TILE_FLAG;
}

/* Samples a tile below `node` (a split, or a tile with its flag) whose box is `range`: of a mixture whose sum,
 * positive, is what the rows give to it. u and range as in acdf_tree_sample. Returns the tile's number;
 * *probability becomes its share of the mixture. */
ACDF_FN uint32_t acdf_blend_sample_below(const AcdfBlend* blend, const AcdfMixture* mix, uint32_t node, double* u,
                                         AcdfRange* range, double* probability) {
    switch (mix->count) {
    case 1:
        return acdf_blend_sample_rows(blend, mix, 1, node, u, range, probability);
    case 2:
        return acdf_blend_sample_rows(blend, mix, 2, node, u, range, probability);
    case 3:
        return acdf_blend_sample_rows(blend, mix, 3, node, u, range, probability);
    default:
        return acdf_blend_sample_rows(blend, mix, 4, node, u, range, probability);
    }
}

/* Samples a tile of a mixture. */
ACDF_FN uint32_t acdf_blend_sample_tile(const AcdfBlend* blend, const AcdfMixture* mix, double* u, AcdfRange* range,
                                        double* probability) {
    return acdf_blend_sample_below(blend, mix, acdf_blend_root(blend), u, range, probability);
}

/* Finds the tile of a grid square below `node`, whose box is `range`; square, range and strata as in
 * acdf_tree_find. *probability becomes its share of the mixture, 0 where no sample can fall. */
ACDF_FN uint32_t acdf_blend_find_below(const AcdfBlend* blend, const AcdfMixture* mix, uint32_t node,
                                       const uint32_t* square, AcdfRange* range, AcdfStratum* strata,
                                       double* probability) {
    switch (mix->count) {
    case 0:
        return acdf_blend_find_rows(blend, mix, 0, node, square, range, strata, probability);
    case 1:
        return acdf_blend_find_rows(blend, mix, 1, node, square, range, strata, probability);
    case 2:
        return acdf_blend_find_rows(blend, mix, 2, node, square, range, strata, probability);
    case 3:
        return acdf_blend_find_rows(blend, mix, 3, node, square, range, strata, probability);
    default:
        return acdf_blend_find_rows(blend, mix, 4, node, square, range, strata, probability);
    }
}

/* Finds the tile of a grid square. */
ACDF_FN uint32_t acdf_blend_find_tile(const AcdfBlend* blend, const AcdfMixture* mix, const uint32_t* square,
                                      AcdfRange* range, AcdfStratum* strata, double* probability) {
    return acdf_blend_find_below(blend, mix, acdf_blend_root(blend), square, range, strata, probability);
}

#ifdef __cplusplus
}
#endif
#endif
