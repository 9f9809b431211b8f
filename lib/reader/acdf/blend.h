/* Distributions that share their fine structure: one freestanding header over acdf/sample.h, valid C99, C++17 and
 * CUDA/HIP/SYCL, with the same contract (SPEC.md §5.6, §6.7).
 *
 * Boxes are split in two until tiles are left. Splits and tiles are stored once; each bin has a *row* of one byte a
 * split: the probability of its lower part. What a caller draws from is a *mixture* of up to four rows, walked side
 * by side: its density is exactly the weighted sum of theirs, at the price of one more byte read a split and row.
 * Within a tile a tree of curves refines, for all bins alike. */
#ifndef ACDF_BLEND_H
#define ACDF_BLEND_H

#include <acdf/sample.h>

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

/* Adds row `index` unless its weight is 0. */
ACDF_FN void acdf_mixture_add(AcdfMixture* mix, const AcdfBlend* blend, uint32_t index, double weight) {
    if (!(weight > 0.0)) return;
    mix->row[mix->count] = blend->rows + (size_t)index * (blend->tiles->tile_count - 1);
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

/* The walks below are written for a number of rows that the compiler knows: weights then stay in registers. */
#ifndef ACDF_INLINE
#if defined(__CUDACC__)
#define ACDF_INLINE static __forceinline__ __host__ __device__
#elif defined(__GNUC__)
#define ACDF_INLINE static inline __attribute__((always_inline))
#else
#define ACDF_INLINE ACDF_FN
#endif
#endif

/* Random numbers are kept as what they are of the weight of the box so far, x = u * weight: a split only subtracts
 * from that of its axis, and the division that rescales the other one is not waited for. Which part comes next is
 * left to a branch: where it is guessed, the loads of the next split do not wait for this one's. */
ACDF_INLINE uint32_t acdf_blend_sample_rows(const AcdfBlend* blend, const AcdfMixture* mix, const int rows,
                                            double* u, AcdfRange* range, double* probability) {
    const uint16_t* codebook = blend->tiles->codebook;
    const double whole = acdf_mixture_sum(mix);
    double weight[ACDF_MAX_ROWS_MIXED], chosen = whole, x[2];
    uint32_t node = blend->tiles->tile_count > 1 ? 0 : ACDF_TILE_FLAG;
    int i;
    x[0] = u[0] * whole;
    x[1] = u[1] * whole;
    for (i = 0; i < rows; ++i) weight[i] = mix->weight[i];
    while (!(node & ACDF_TILE_FLAG)) {
        const AcdfSplit* split = &blend->splits[node];
        const uint32_t axis = split->place & 7u, position = split->place >> 3;
        double lower[ACDF_MAX_ROWS_MIXED], higher[ACDF_MAX_ROWS_MIXED], low = 0.0, high = 0.0;
        for (i = 0; i < rows; ++i) {
            const double code = (double)codebook[mix->row[i][node]];
            low += lower[i] = weight[i] * (code * (1.0 / 65535.0));
            high += higher[i] = weight[i] * ((65535.0 - code) * (1.0 / 65535.0));
        }
        if (!(x[axis] < low) && high > 0.0) {
            x[axis] -= low;
            x[axis ^ 1u] *= high / chosen;
            chosen = high;
            for (i = 0; i < rows; ++i) weight[i] = higher[i];
            range[axis].low = position;
            node = split->child[1];
        } else {
            x[axis ^ 1u] *= low / chosen;
            chosen = low;
            for (i = 0; i < rows; ++i) weight[i] = lower[i];
            range[axis].high = position;
            node = split->child[0];
        }
    }
    for (i = 0; i < 2; ++i) u[i] = x[i] < chosen ? x[i] / chosen : 1.0;
    *probability = acdf_positive(chosen / whole);
    return node & ~ACDF_TILE_FLAG;
}

/* Where a square lies does not depend on weights: the walk is free of branches on the data, and the products of the
 * weights follow it. */
ACDF_INLINE uint32_t acdf_blend_find_rows(const AcdfBlend* blend, const AcdfMixture* mix, const int rows,
                                          const uint32_t* square, AcdfRange* range, AcdfStratum* strata,
                                          double* probability) {
    const uint16_t* codebook = blend->tiles->codebook;
    const double whole = acdf_mixture_sum(mix);
    /* At or above every `place` of its axis and a position up to the square's. */
    const uint32_t key0 = square[0] << 3 | 7u, key1 = square[1] << 3 | 7u;
    double weight[ACDF_MAX_ROWS_MIXED], chosen = 0.0;
    uint32_t node = blend->tiles->tile_count > 1 ? 0 : ACDF_TILE_FLAG, bound[2][2];
    int i;
    for (i = 0; i < 2; ++i) {
        bound[i][0] = range[i].high;
        bound[i][1] = range[i].low;
    }
    for (i = 0; i < rows; ++i) weight[i] = mix->weight[i];
    while (!(node & ACDF_TILE_FLAG)) {
        const AcdfSplit* split = &blend->splits[node];
        const uint32_t place = split->place, axis = place & 7u;
        const uint32_t first = key0 >= place, upper = first ^ ((first ^ (key1 >= place)) & axis);
        const uint32_t other = (0u - upper) & 0xFFFFu; /* 65535 - code is code ^ 65535 */
        if (strata) {
            double low = 0.0, high = 0.0, below;
            for (i = 0; i < rows; ++i) {
                const double code = (double)codebook[mix->row[i][node]];
                low += weight[i] * (code * (1.0 / 65535.0));
                high += weight[i] * ((65535.0 - code) * (1.0 / 65535.0));
            }
            below = low / (low + high);
            if (upper) strata[axis].low += strata[axis].width * below;
            strata[axis].width *= upper ? high / (low + high) : below;
        }
        for (i = 0; i < rows; ++i)
            weight[i] *= (double)(int32_t)(codebook[mix->row[i][node]] ^ other) * (1.0 / 65535.0);
        bound[axis][upper] = place >> 3;
        node = split->child[upper];
    }
    for (i = 0; i < 2; ++i) {
        range[i].high = bound[i][0];
        range[i].low = bound[i][1];
    }
    for (i = 0; i < rows; ++i) chosen += weight[i];
    *probability = chosen > 0.0 ? acdf_positive(chosen / whole) : 0.0;
    return node & ~ACDF_TILE_FLAG;
}

/* Draws a tile of the mixture, whose sum is positive; u and range as in acdf_tree_sample. Returns the tile's
 * number; *probability becomes its share of the mixture. */
ACDF_FN uint32_t acdf_blend_sample_tile(const AcdfBlend* blend, const AcdfMixture* mix, double* u, AcdfRange* range,
                                        double* probability) {
    switch (mix->count) {
    case 1:
        return acdf_blend_sample_rows(blend, mix, 1, u, range, probability);
    case 2:
        return acdf_blend_sample_rows(blend, mix, 2, u, range, probability);
    case 3:
        return acdf_blend_sample_rows(blend, mix, 3, u, range, probability);
    default:
        return acdf_blend_sample_rows(blend, mix, 4, u, range, probability);
    }
}

/* Finds the tile of a grid square; square, range and strata as in acdf_tree_find. *probability becomes its share of
 * the mixture, 0 where no sample can fall. */
ACDF_FN uint32_t acdf_blend_find_tile(const AcdfBlend* blend, const AcdfMixture* mix, const uint32_t* square,
                                      AcdfRange* range, AcdfStratum* strata, double* probability) {
    switch (mix->count) {
    case 0:
        return acdf_blend_find_rows(blend, mix, 0, square, range, strata, probability);
    case 1:
        return acdf_blend_find_rows(blend, mix, 1, square, range, strata, probability);
    case 2:
        return acdf_blend_find_rows(blend, mix, 2, square, range, strata, probability);
    case 3:
        return acdf_blend_find_rows(blend, mix, 3, square, range, strata, probability);
    default:
        return acdf_blend_find_rows(blend, mix, 4, square, range, strata, probability);
    }
}

/* Draws a cell of the mixture, as acdf_tree_sample does of a tree. Returns its probability, > 0. */
ACDF_FN double acdf_blend_sample(const AcdfBlend* blend, const AcdfMixture* mix, double* u, AcdfRange* range) {
    double probability;
    const uint32_t tile = acdf_blend_sample_tile(blend, mix, u, range, &probability);
    if (!blend->roots || blend->roots[tile] == ACDF_NO_ROOT) return probability;
    return acdf_positive(probability * acdf_tree_sample(blend->tree, blend->roots[tile], u, range));
}

/* Finds the cell of a grid square, as acdf_tree_find does. Returns its probability, 0 where no sample can fall. */
ACDF_FN double acdf_blend_find(const AcdfBlend* blend, const AcdfMixture* mix, const uint32_t* square,
                               AcdfRange* range, AcdfStratum* strata) {
    double probability, inside;
    const uint32_t tile = acdf_blend_find_tile(blend, mix, square, range, strata, &probability);
    if (!(probability > 0.0) || !blend->roots || blend->roots[tile] == ACDF_NO_ROOT) return probability;
    inside = acdf_tree_find(blend->tree, blend->roots[tile], square, range, strata);
    return inside > 0.0 ? acdf_positive(probability * inside) : 0.0;
}

/* ---- many at once ------------------------------------------------------------------------------------
 * A walk waits for its loads and comparisons most of the time. Several of them, a split each in turn, fill that
 * time; none of them has a branch on its data, which could not be guessed. The results are those of the walks
 * above, bit for bit. */

enum { ACDF_LANES = 12 };

typedef struct AcdfLane {
    const uint8_t* row[ACDF_MAX_ROWS_MIXED]; /* one again, of weight 0, where the mixture has fewer */
    double part[2][ACDF_MAX_ROWS_MIXED];     /* weights in both parts of the last split */
    double x[2], chosen;                     /* as in acdf_blend_sample_rows */
    uint32_t key[2];                         /* as in acdf_blend_find_rows */
    uint32_t upper;                          /* the part that was chosen */
    uint32_t node;
    uint32_t bound[2][2]; /* of each axis: high, low */
} AcdfLane;

/* For a mixture of at least one row; `range` is the whole. */
ACDF_FN void acdf_lane_begin(AcdfLane* lane, const AcdfBlend* blend, const AcdfMixture* mix,
                             const AcdfRange* range) {
    int i;
    for (i = 0; i < ACDF_MAX_ROWS_MIXED; ++i) {
        lane->row[i] = mix->row[i < mix->count ? i : 0];
        lane->part[0][i] = i < mix->count ? mix->weight[i] : 0.0;
    }
    for (i = 0; i < 2; ++i) {
        lane->bound[i][0] = range[i].high;
        lane->bound[i][1] = range[i].low;
    }
    lane->upper = 0;
    lane->node = blend->tiles->tile_count > 1 ? 0 : ACDF_TILE_FLAG;
}

ACDF_INLINE void acdf_lane_take(AcdfLane* lane, const AcdfSplit* split, uint32_t axis, uint32_t upper) {
    lane->bound[axis][upper] = split->place >> 3;
    lane->upper = upper;
    lane->node = split->child[upper];
}

ACDF_INLINE void acdf_lane_sample_step(AcdfLane* lane, const AcdfBlend* blend, const int rows) {
    const AcdfSplit* split = &blend->splits[lane->node];
    const double* weight = lane->part[lane->upper];
    const uint32_t axis = split->place & 7u;
    double sum[2], less[2], lower[ACDF_MAX_ROWS_MIXED], higher[ACDF_MAX_ROWS_MIXED];
    uint32_t upper;
    int i;
    sum[0] = sum[1] = 0.0;
    for (i = 0; i < rows; ++i) {
        const double code = (double)blend->tiles->codebook[lane->row[i][lane->node]];
        sum[0] += lower[i] = weight[i] * (code * (1.0 / 65535.0));
        sum[1] += higher[i] = weight[i] * ((65535.0 - code) * (1.0 / 65535.0));
    }
    for (i = 0; i < rows; ++i) {
        lane->part[0][i] = lower[i];
        lane->part[1][i] = higher[i];
    }
    less[0] = 0.0;
    less[1] = sum[0];
    upper = (uint32_t)(lane->x[axis] >= sum[0]) & (uint32_t)(sum[1] > 0.0);
    lane->x[axis] -= less[upper];
    lane->x[axis ^ 1u] *= sum[upper] / lane->chosen;
    lane->chosen = sum[upper];
    acdf_lane_take(lane, split, axis, upper);
}

ACDF_INLINE void acdf_lane_find_step(AcdfLane* lane, const AcdfBlend* blend, const int rows) {
    const AcdfSplit* split = &blend->splits[lane->node];
    const uint32_t axis = split->place & 7u;
    const uint32_t upper = lane->key[axis] >= split->place, other = (0u - upper) & 0xFFFFu;
    int i;
    for (i = 0; i < rows; ++i)
        lane->part[0][i] *=
            (double)(int32_t)(blend->tiles->codebook[lane->row[i][lane->node]] ^ other) * (1.0 / 65535.0);
    acdf_lane_take(lane, split, axis, upper);
}

/* Walks all of them to their tiles. `find`: to those of squares, else to those of random numbers. */
ACDF_INLINE void acdf_lanes_walk(AcdfLane* lanes, int count, const AcdfBlend* blend, const int rows,
                                 const int find) {
    int open[ACDF_LANES], k, n = 0;
    for (k = 0; k < count; ++k)
        if (!(lanes[k].node & ACDF_TILE_FLAG)) open[n++] = k;
    while (n > 0)
        for (k = 0; k < n;) {
            AcdfLane* lane = &lanes[open[k]];
            if (find) acdf_lane_find_step(lane, blend, rows);
            else acdf_lane_sample_step(lane, blend, rows);
            if (lane->node & ACDF_TILE_FLAG) open[k] = open[--n];
            else ++k;
        }
}

/* Draws a tile for each of `count` mixtures, at most ACDF_LANES, of one to four rows; u, range and probability as
 * in acdf_blend_sample_tile. Tiles are cells here. */
ACDF_FN void acdf_blend_sample_lanes(const AcdfBlend* blend, const AcdfMixture* const* mix, int count,
                                     double (*u)[2], AcdfRange (*range)[2], double* probability) {
    AcdfLane lanes[ACDF_LANES];
    int k, axis, rows = 0;
    for (k = 0; k < count; ++k) {
        const double whole = acdf_mixture_sum(mix[k]);
        acdf_lane_begin(&lanes[k], blend, mix[k], range[k]);
        for (axis = 0; axis < 2; ++axis) lanes[k].x[axis] = u[k][axis] * whole;
        lanes[k].chosen = whole;
        rows = rows > mix[k]->count ? rows : mix[k]->count;
    }
    if (rows <= 2) acdf_lanes_walk(lanes, count, blend, 2, 0);
    else acdf_lanes_walk(lanes, count, blend, 4, 0);
    for (k = 0; k < count; ++k) {
        const AcdfLane* lane = &lanes[k];
        for (axis = 0; axis < 2; ++axis) {
            u[k][axis] = lane->x[axis] < lane->chosen ? lane->x[axis] / lane->chosen : 1.0;
            range[k][axis].high = lane->bound[axis][0];
            range[k][axis].low = lane->bound[axis][1];
        }
        probability[k] = acdf_positive(lane->chosen / acdf_mixture_sum(mix[k]));
    }
}

/* Finds the tile of a square in each of them, as acdf_blend_find_tile does. */
ACDF_FN void acdf_blend_find_lanes(const AcdfBlend* blend, const AcdfMixture* const* mix, int count,
                                   const uint32_t (*square)[2], AcdfRange (*range)[2], double* probability) {
    AcdfLane lanes[ACDF_LANES];
    int k, i, axis, rows = 0;
    for (k = 0; k < count; ++k) {
        acdf_lane_begin(&lanes[k], blend, mix[k], range[k]);
        for (axis = 0; axis < 2; ++axis) lanes[k].key[axis] = square[k][axis] << 3 | 7u;
        rows = rows > mix[k]->count ? rows : mix[k]->count;
    }
    if (rows <= 2) acdf_lanes_walk(lanes, count, blend, 2, 1);
    else acdf_lanes_walk(lanes, count, blend, 4, 1);
    for (k = 0; k < count; ++k) {
        double chosen = 0.0;
        for (i = 0; i < mix[k]->count; ++i) chosen += lanes[k].part[0][i];
        for (axis = 0; axis < 2; ++axis) {
            range[k][axis].high = lanes[k].bound[axis][0];
            range[k][axis].low = lanes[k].bound[axis][1];
        }
        probability[k] = chosen > 0.0 ? acdf_positive(chosen / acdf_mixture_sum(mix[k])) : 0.0;
    }
}

#ifdef __cplusplus
}
#endif
#endif
