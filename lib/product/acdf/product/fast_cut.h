/* A cut of local environment maps of the fast shape (acdf/fast.h): each bright tile and each group of tiles has a
 * probability of its own, and in some groups each tile. What product sampling weighs at a shading point
 * (acdf/product/product.h). One freestanding header over acdf/local.h, valid C99, C++17 and CUDA/HIP/SYCL.
 *
 * In groups that are not open, tiles get what the rows give to them, and in tiles cells what the file does: light
 * times cosine. Probabilities of bright tiles, groups and tiles are integers, as those of rows are: samples and
 * pdfs agree to the last bit. */
#ifndef ACDF_FAST_CUT_H
#define ACDF_FAST_CUT_H

#include <acdf/local.h>

#ifdef __cplusplus
extern "C" {
#endif

enum {
    ACDF_FAST_CUT_GROUPS = ACDF_MOST_GROUP_HEARTS, /* at most: files with more are not cut */
    ACDF_FAST_CUT_PARTS = ACDF_MAX_BRIGHT_TILES + 16 + ACDF_FAST_CUT_GROUPS,
    ACDF_FAST_CUT_UPPER = (ACDF_FAST_CUT_PARTS / 16 + 15) / 16 * 16,
    ACDF_FAST_CUT_OPEN = 16 /* groups whose tiles have probabilities of their own */
};

/* Of what makes the weights of a cut: steps that all of them have together, but for one more of each. */
#define ACDF_FAST_CUT_STEPS 536870912.0f /* 2^29 */

/* Parts are bright tiles, then at least one empty part up to a multiple of sixteen, then groups. */
typedef struct AcdfFastCut {
    int32_t whole;                      /* the last end; 0: there is nothing to sample */
    uint32_t bright_tiles;              /* how many parts are bright tiles: a multiple of 16 */
    uint32_t count;                     /* of parts; a multiple of 16 */
    int32_t upper[ACDF_FAST_CUT_UPPER]; /* every sixteenth end, and all ones behind them */
    int32_t end[ACDF_FAST_CUT_PARTS];   /* cumulative weights */
    uint8_t open[ACDF_FAST_CUT_GROUPS]; /* 1 more than the number of the group's `tile`; 0: it has none */
    int32_t tile[ACDF_FAST_CUT_OPEN][ACDF_FAST_GROUP]; /* cumulative weights in groups */
} AcdfFastCut;

/* Whether points of a file of the fast shape can be cut: there are tables, and no more groups than cuts have. */
ACDF_INLINE int acdf_fast_cut_serves(const AcdfLocal* local) {
    return local->tables && local->tables->group_hearts;
}

/* How many parts stand before those of groups: bright tiles, and at least one that is none. */
ACDF_INLINE uint32_t acdf_fast_cut_bright_tiles(const AcdfLocal* local) {
    return (local->bright_tile_count + 16u) & ~15u;
}

/* ---- what a cut is made of -------------------------------------------------------------------------- */

/* The weight of each bright tile, and room for one more; of those that a normal does not see 0. */
ACDF_FN void acdf_fast_bright_tile_weights(const AcdfLocal* local, const AcdfLocalPoint* point,
                                           double out[ACDF_MAX_BRIGHT_TILES]) {
    const AcdfBrightTilePair* pair = acdf_local_bright_tiles(local->tables);
    const AcdfScaledNormal normal = acdf_local_scaled_normal(point);
    uint32_t left = acdf_local_seen(local, point->by.fast.facet), k;
    for (k = 0; k < ACDF_MAX_BRIGHT_TILES; ++k) out[k] = 0.0;
#ifdef ACDF_SSE2
    {
        const AcdfHorizon horizon = acdf_horizon(&normal);
        const __m128d inverse = _mm_set1_pd(1.0 / point->length);
        for (; left; left &= left - 1) {
            k = acdf_lowest_bit(left);
            _mm_storeu_pd(out + 2 * k, acdf_pair_weights(&horizon, pair + k, inverse));
        }
    }
#else
    for (; left; left &= left - 1) {
        k = acdf_lowest_bit(left);
        out[2 * k] = acdf_pair_weight(&normal, pair + k, 0, 1.0 / point->length);
        out[2 * k + 1] = acdf_pair_weight(&normal, pair + k, 1, 1.0 / point->length);
    }
#endif
}

/* What the mixture gives to each group, of 32767 times its whole: as many as a row has ends, into the first ones;
 * there is room for a number more. */
ACDF_FN void acdf_fast_group_masses(const AcdfFast* fast, const AcdfFastMixture* mix, int32_t* out) {
    uint32_t i;
    int k;
#ifdef ACDF_SSE2
    const __m128i weight = _mm_packs_epi32(acdf_fast_weights(mix), _mm_setzero_si128());
    const __m128i weight01 = _mm_shuffle_epi32(weight, 0), weight2 = _mm_shuffle_epi32(weight, 0x55);
    __m128i before = _mm_setzero_si128(), end[3], sum[2];
    for (i = 0; i < fast->ends; i += 8) {
        for (k = 0; k < 3; ++k) end[k] = _mm_loadu_si128((const __m128i*)(const void*)(mix->group[k] + i));
        acdf_fast_mixed(end, weight01, weight2, sum);
        for (k = 0; k < 2; ++k) { /* less those one before */
            const __m128i shifted = _mm_or_si128(_mm_slli_si128(sum[k], 4), _mm_srli_si128(before, 12));
            _mm_storeu_si128((__m128i*)(void*)(out + i + 4 * (uint32_t)k), _mm_sub_epi32(sum[k], shifted));
            before = sum[k];
        }
    }
#else
    int32_t before = 0;
    for (i = 0; i < fast->ends; ++i) {
        int32_t sum = 0;
        for (k = 0; k < ACDF_FAST_ROWS; ++k) sum += mix->weight[k] * (int32_t)mix->group[k][i];
        out[i] = sum - before;
        before = sum;
    }
#endif
}

/* What the mixture gives to each tile of a group, of 255 times the group's whole. */
ACDF_FN void acdf_fast_tile_masses(const AcdfFastMixture* mix, const AcdfFastGroup* group, uint32_t first,
                                   int32_t out[ACDF_FAST_GROUP]) {
    int32_t before = 0;
    uint32_t i;
#ifdef ACDF_SSE2
    __m128i low[3], high[3], sum[4];
    int k;
    acdf_fast_tile_rows(mix, first, low, high);
    acdf_fast_mixed_sixteen(low, high, group->weight, sum);
    for (k = 0; k < 4; ++k) _mm_storeu_si128((__m128i*)(void*)(out + 4 * k), sum[k]);
#else
    for (i = 0; i < ACDF_FAST_GROUP; ++i) out[i] = acdf_fast_tile_begin(mix, group, first, i + 1);
#endif
    for (i = 0; i < ACDF_FAST_GROUP; ++i) {
        const int32_t end = out[i];
        out[i] = end - before;
        before = end;
    }
}

/* Cumulative weights of numbers that add up to about 1, a multiple of 16: more than 0 where they are. */
ACDF_INLINE void acdf_fast_cut_ends(const float* share, uint32_t count, int32_t* end) {
    uint32_t i;
#ifdef ACDF_SSE2
    const __m128 steps = _mm_set1_ps(ACDF_FAST_CUT_STEPS), none = _mm_setzero_ps();
    __m128i sum = _mm_setzero_si128();
    for (i = 0; i < count; i += 4) {
        const __m128 some = _mm_loadu_ps(share + i);
        __m128i x =
            _mm_sub_epi32(_mm_cvttps_epi32(_mm_mul_ps(some, steps)), _mm_castps_si128(_mm_cmpgt_ps(some, none)));
        x = _mm_add_epi32(x, _mm_slli_si128(x, 4));
        x = _mm_add_epi32(x, _mm_slli_si128(x, 8));
        x = _mm_add_epi32(x, sum);
        _mm_storeu_si128((__m128i*)(void*)(end + i), x);
        sum = _mm_shuffle_epi32(x, 0xFF);
    }
#else
    int32_t sum = 0;
    for (i = 0; i < count; ++i) {
        sum += (int32_t)(share[i] * ACDF_FAST_CUT_STEPS) + (int32_t)(share[i] > 0.0f);
        end[i] = sum;
    }
#endif
}

/* Makes a cut of the shares of its parts, which add up to about 1. */
ACDF_FN void acdf_fast_cut_finish(AcdfFastCut* cut, const float* share) {
    uint32_t i;
    acdf_fast_cut_ends(share, cut->count, cut->end);
    for (i = 0; i < ACDF_FAST_CUT_UPPER; ++i) cut->upper[i] = 0x7FFFFFFF;
    for (i = 0; 16 * i < cut->count; ++i) cut->upper[i] = cut->end[16 * i + 15];
    cut->whole = cut->end[cut->count - 1];
}

/* ---- samples and pdfs ---------------------------------------------------------------------------- */

/* The first of sixteen ends that is above x, which is below the last one. */
ACDF_INLINE uint32_t acdf_fast_cut_search(const int32_t* end, double x) {
#ifdef ACDF_SSE2
    __m128i ends[4];
    int k;
    for (k = 0; k < 4; ++k) ends[k] = _mm_loadu_si128((const __m128i*)(const void*)(end + 4 * k));
    return acdf_lowest_bit(acdf_fast_above(ends, acdf_fast_floor(x)));
#else
    const int32_t at = (int32_t)x;
    uint32_t i = 0;
    while (!(end[i] > at)) ++i;
    return i;
#endif
}

/* One of cumulative weights. */
typedef struct AcdfFastPart {
    double mass, below; /* its weight, and that of all before it */
} AcdfFastPart;

ACDF_INLINE AcdfFastPart acdf_fast_cut_part(const int32_t* end, uint32_t i) {
    const uint32_t inner = (uint32_t)(i > 0);
    const int32_t below = end[i - inner] & (int32_t)(0u - inner);
    AcdfFastPart out;
    out.mass = (double)(end[i] - below);
    out.below = (double)below;
    return out;
}

/* Samples a tile of a group; *share, which is the group's, becomes the tile's. */
ACDF_INLINE uint32_t acdf_fast_cut_sample_tile(const AcdfLocalPoint* point, const AcdfFastCut* cut, uint32_t number,
                                               double* u, AcdfFastShare* share) {
    const uint32_t first = ACDF_FAST_GROUP * number, list = cut->open[number];
    AcdfFastTile tile;
    double whole, y;
    if (list > 0) {
        const int32_t* end = cut->tile[list - 1];
        uint32_t i;
        AcdfFastPart part;
        whole = (double)end[ACDF_FAST_GROUP - 1];
        y = acdf_fast_scaled(u[1], whole);
        i = acdf_fast_cut_search(end, y);
        part = acdf_fast_cut_part(end, i);
        tile.number = first + i;
        tile.mass = part.mass;
        tile.below = part.below;
    } else {
        const AcdfFastGroup group = acdf_fast_find_group(&point->by.fast.mix, number);
        whole = 255.0 * group.whole;
        y = acdf_fast_scaled(u[1], whole);
        tile = acdf_fast_tile_of(&point->by.fast.mix, &group, first, y);
    }
    u[1] = (y - tile.below) / tile.mass;
    share->of *= tile.mass;
    share->all *= whole;
    return tile.number;
}

/* The share of a tile of a group, of the group's. */
ACDF_INLINE void acdf_fast_cut_find_tile(const AcdfLocalPoint* point, const AcdfFastCut* cut, uint32_t tile,
                                         AcdfFastShare* share) {
    const uint32_t number = tile / ACDF_FAST_GROUP, i = tile % ACDF_FAST_GROUP, list = cut->open[number];
    if (list > 0) {
        const int32_t* end = cut->tile[list - 1];
        share->of *= acdf_fast_cut_part(end, i).mass;
        share->all *= (double)end[ACDF_FAST_GROUP - 1];
    } else {
        const AcdfFastGroup group = acdf_fast_find_group(&point->by.fast.mix, number);
        share->of *= acdf_fast_find_tile(&point->by.fast.mix, &group, tile - i, i);
        share->all *= 255.0 * (group.whole > 1.0 ? group.whole : 1.0); /* of dark groups all masses are 0 */
    }
}

/* The share of a tile, whose light has number `light` - 1; 0: it has none. */
ACDF_INLINE AcdfFastShare acdf_fast_cut_find(const AcdfLocalPoint* point, const AcdfFastCut* cut, uint32_t tile,
                                             uint32_t light) {
    const uint32_t part = light > 0 ? light - 1 : cut->bright_tiles + tile / ACDF_FAST_GROUP;
    AcdfFastShare share;
    share.of = acdf_fast_cut_part(cut->end, part).mass;
    share.all = (double)cut->whole;
    if (light == 0) acdf_fast_cut_find_tile(point, cut, tile, &share);
    return share;
}

/* Samples a tile by two numbers; `left` becomes what is left of them, *share that of acdf_fast_cut_find. */
ACDF_INLINE uint32_t acdf_fast_cut_choose_part(const AcdfLocal* local, const AcdfLocalPoint* point,
                                               const AcdfFastCut* cut, const double u[2], double left[2],
                                               AcdfFastShare* share) {
    const double x = acdf_fast_scaled(acdf_unit_interval(u[0]), (double)cut->whole);
    AcdfFastPart part;
    uint32_t block = 0, number;
    while (!(cut->upper[block + 15] > (int32_t)x)) block += 16;
    block += acdf_fast_cut_search(cut->upper + block, x);
    number = 16 * block + acdf_fast_cut_search(cut->end + 16 * block, x);
    part = acdf_fast_cut_part(cut->end, number);
    left[0] = (x - part.below) / part.mass;
    left[1] = acdf_unit_interval(u[1]);
    share->of = part.mass;
    share->all = (double)cut->whole;
    if (number < cut->bright_tiles) return local->bright_tiles[number].tile;
    return acdf_fast_cut_sample_tile(point, cut, number - cut->bright_tiles, left, share);
}

/* Pdf per steradian with which acdf_fast_cut_sample samples `direction` (unit). */
ACDF_CALLED float acdf_fast_cut_pdf(const AcdfLocal* local, const AcdfLocalPoint* point, const AcdfFastCut* cut,
                                    const float direction[3]) {
    const AcdfGrid grid = acdf_environment_grid(&local->environment);
    AcdfRange range[2];
    AcdfFastGrid cells;
    AcdfFastShare share;
    uint32_t square[2], tile;
    if (cut->whole == 0 || !acdf_local_square(&grid, direction, square)) return 0.0f;
    tile = acdf_local_fast_tile(local, square, range);
    share = acdf_fast_cut_find(point, cut, tile, acdf_local_bright_tile_of(local, tile));
    cells = acdf_local_fast_record(local, tile, range);
    share.of *= acdf_fast_find_cell(&cells, square, range);
    share.all *= ACDF_FAST_STEPS;
    return acdf_local_fast_cell_pdf(local, &grid, range, &share);
}

/* Samples a direction; u0 (axis 0) and u1 (axis 1) in [0, 1]; values outside are clamped, NaN counts as 0. pdf 0
 * (and no direction) where the cut is empty. */
ACDF_CALLED AcdfDirectionSample acdf_fast_cut_sample(const AcdfLocal* local, const AcdfLocalPoint* point,
                                                     const AcdfFastCut* cut, double u0, double u1) {
    const AcdfGrid grid = acdf_environment_grid(&local->environment);
    AcdfDirectionSample out = {{0.0f, 0.0f, 0.0f}, 0.0f};
    AcdfRange range[2];
    AcdfFastGrid cells;
    AcdfFastShare share;
    uint32_t tile;
    double u[2], left[2];
    if (cut->whole == 0) return out;
    u[0] = u0;
    u[1] = u1;
    acdf_sphere_ranges(grid.columns, grid.rows, range);
    tile = acdf_fast_cut_choose_part(local, point, cut, u, left, &share);
    cells = acdf_local_fast_record(local, tile, range);
    share.of *= acdf_fast_sample_cell(&cells, left, range);
    share.all *= ACDF_FAST_STEPS;
    return acdf_local_fast_direction_sample(local, &grid, range, left, &share);
}

#ifdef __cplusplus
}
#endif
#endif
