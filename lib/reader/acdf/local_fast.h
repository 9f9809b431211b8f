/* Samples and pdfs in local environment maps of the fast shape (acdf/fast.h). Part of acdf/local.h. */
#ifndef ACDF_LOCAL_FAST_H
#define ACDF_LOCAL_FAST_H

#include <acdf/local_position.h>

#ifdef __cplusplus
extern "C" {
#endif

/* The grid of a tile and its box, by tables. */
ACDF_INLINE AcdfFastGrid acdf_local_fast_record(const AcdfLocal* local, uint32_t tile, AcdfRange* range) {
    const AcdfTileRecord* record = acdf_local_tile(local->tables, tile);
    AcdfFastGrid out;
    int axis;
    out.ends = local->fast.grid + record->root + 2;
    for (axis = 0; axis < 2; ++axis) {
        out.shift[axis] = record->step[axis];
        out.count[axis] = record->step[2 + axis];
    }
    acdf_tile_range(record, range);
    return out;
}

/* The grid of a tile that was sampled, and its box. */
ACDF_INLINE AcdfFastGrid acdf_local_fast_sampled(const AcdfLocal* local, uint32_t tile, AcdfRange* range) {
    uint32_t node = acdf_blend_root(&local->blend), before = 0;
    if (local->tables) return acdf_local_fast_record(local, tile, range);
    /* Splits and tiles are numbered as the traversal meets them; a part has a tile more than splits. */
    while (!(node & ACDF_TILE_FLAG)) {
        const AcdfSplit* split = &local->blend.splits[node];
        const uint32_t upper = split->child[1];
        const uint32_t first = upper & ACDF_TILE_FLAG ? upper & ~ACDF_TILE_FLAG : before + (upper - node);
        const int in_upper = tile >= first;
        acdf_range_cut(&range[split->place & 7u], split->place >> 3, in_upper);
        if (in_upper) before = first;
        node = split->child[in_upper];
    }
    return acdf_fast_grid(&local->fast, local->blend.roots[tile], range);
}

/* The tile of a square; without tables `range` becomes its own. */
ACDF_INLINE uint32_t acdf_local_fast_tile(const AcdfLocal* local, const uint32_t* square, AcdfRange* range) {
    uint32_t node = acdf_blend_root(&local->blend);
    if (local->tables) node = acdf_tile_block_at(acdf_local_words(local->tables), &local->tables->blocks, square);
    while (!(node & ACDF_TILE_FLAG)) {
        const AcdfSplit* split = &local->blend.splits[node];
        const uint32_t in_upper = acdf_split_upper(split, square);
        if (!local->tables) acdf_range_cut(&range[split->place & 7u], split->place >> 3, (int)in_upper);
        node = split->child[in_upper];
    }
    return node & ~ACDF_TILE_FLAG;
}

/* A bright tile that is sampled: its number, its weight, and the sum of those before it. */
typedef struct AcdfSampledBrightTile {
    uint32_t number;
    double weight, before;
} AcdfSampledBrightTile;

/* Samples a bright tile by x of the sum of weights: the first one that takes their sum above x. Weight 0 where x is
 * the whole of them, or rounded to it: *whole becomes that. */
ACDF_INLINE AcdfSampledBrightTile acdf_local_find_bright_tile(const AcdfLocal* local, const AcdfLocalPoint* point,
                                                              double x, double* whole) {
    uint32_t left = acdf_local_seen(local, point->by.fast.facet);
    const AcdfScaledNormal normal = acdf_local_scaled_normal(point);
    AcdfSampledBrightTile out = {0, 0.0, 0.0};
    AcdfBrightTilePair room;
#ifdef ACDF_SSE2
    const AcdfHorizon horizon = acdf_horizon(&normal);
    const __m128d inverse = _mm_set1_pd(1.0 / point->length), zero = _mm_setzero_pd(), at = _mm_set1_pd(x);
    __m128d end = zero;
    for (; left; left &= left - 1) {
        const uint32_t k = acdf_lowest_bit(left);
        const __m128d both = acdf_pair_weights(&horizon, acdf_local_pair(local, k, &room), inverse), before = end;
        uint32_t above;
        end = _mm_add_pd(_mm_add_pd(both, _mm_unpacklo_pd(zero, both)), end);
        above = (uint32_t)_mm_movemask_pd(_mm_cmplt_pd(at, end));
        if (above > 0) {
            const uint32_t second = (uint32_t)(above != 3);
            out.number = 2 * k + second;
            out.weight = _mm_cvtsd_f64(second ? _mm_unpackhi_pd(both, both) : both);
            out.before = _mm_cvtsd_f64(second ? end : before);
            return out;
        }
        end = _mm_unpackhi_pd(end, end);
    }
    *whole = _mm_cvtsd_f64(end);
#else
    const double inverse = 1.0 / point->length;
    double end = 0.0;
    for (; left; left &= left - 1) {
        const uint32_t k = acdf_lowest_bit(left);
        const AcdfBrightTilePair* pair = acdf_local_pair(local, k, &room);
        const double first = acdf_pair_weight(&normal, pair, 0, inverse),
                     second = acdf_pair_weight(&normal, pair, 1, inverse);
        const double middle = first + end, last = (second + first) + end;
        if (x < last) {
            const uint32_t is_second = (uint32_t) !(x < middle);
            out.number = 2 * k + is_second;
            out.weight = is_second ? second : first;
            out.before = is_second ? middle : end;
            return out;
        }
        end = last;
    }
    *whole = end;
#endif
    return out;
}

/* The bright tile that x of the sum of weights samples at a point; x is rescaled to [0, 1]. */
ACDF_INLINE AcdfSampledBrightTile acdf_local_fast_bright_tile(const AcdfLocal* local, const AcdfLocalPoint* point,
                                                              double x, double* u) {
    double whole = 0.0;
    AcdfSampledBrightTile out = acdf_local_find_bright_tile(local, point, x, &whole);
    if (!(out.weight > 0.0)) out = acdf_local_find_bright_tile(local, point, whole * (1.0 - 0x1p-53), &whole);
    *u = acdf_unit_interval((x - out.before) / out.weight);
    return out;
}

/* Samples a cell; u and range as in acdf_tree_sample. Returns its probability. */
ACDF_INLINE AcdfFastShare acdf_local_fast_sample_cell(const AcdfLocal* local, const AcdfLocalPoint* point,
                                                      double* u, AcdfRange* range) {
    const AcdfFastPoint* fast = &point->by.fast;
    const double x = u[0] * point->sum;
    AcdfFastShare share;
    AcdfFastGrid grid;
    uint32_t tile;
    if (x < point->bright_tiles || point->mix.count == 0) {
        const AcdfSampledBrightTile light = acdf_local_fast_bright_tile(local, point, x, u);
        tile = local->bright_tiles[light.number].tile;
        share.of = light.weight;
        share.all = point->sum * ACDF_FAST_STEPS;
    } else {
        const double most = 32767.0 * fast->mix.whole * (1.0 - 0x1p-53);
        const double of_mixture = (x - point->bright_tiles) * fast->step;
        tile = acdf_fast_sample_tile(&local->fast, &fast->mix, of_mixture < most ? of_mixture : most, u, &share);
        share.of *= fast->unit;
        share.all *= ACDF_FAST_STEPS;
    }
    grid = acdf_local_fast_sampled(local, tile, range);
    share.of *= acdf_fast_sample_cell(&grid, u, range);
    return share;
}

/* The cell of a square in its tile, which becomes `range`, and its probability: 0 where no sample can fall. */
ACDF_INLINE AcdfFastShare acdf_local_fast_find(const AcdfLocal* local, const AcdfLocalPoint* point, uint32_t tile,
                                               const uint32_t* square, AcdfRange* range) {
    const AcdfFastGrid grid = local->tables ? acdf_local_fast_record(local, tile, range)
                                            : acdf_fast_grid(&local->fast, local->blend.roots[tile], range);
    const double inside = acdf_fast_find_cell(&grid, square, range);
    const uint32_t light = acdf_local_bright_tile_of(local, tile);
    AcdfFastShare share = acdf_fast_share(&point->by.fast.mix, tile);
    share.of *= point->by.fast.unit;
    if (light > 0) { /* no row gives it any */
        const AcdfScaledNormal normal = acdf_local_scaled_normal(point);
        share.of = acdf_fast_bright_tile_weight(local, &normal, light - 1);
        share.all = point->sum;
    }
    share.of *= inside;
    share.all *= ACDF_FAST_STEPS;
    return share;
}

/* The pdf, at least `least`, in a cell of such a probability. */
ACDF_INLINE float acdf_local_fast_at_least(const AcdfLocal* local, const AcdfGrid* grid, const AcdfRange range[2],
                                           const AcdfFastShare* share, double least) {
    double height, pdf;
    if (local->tables && local->tables->heights) {
        const double* z = acdf_local_heights(local->tables);
        height = z[range[1].low] - z[range[1].high];
    } else height = acdf_grid_height(grid, &range[1]);
    pdf = share->of * (double)grid->columns /
          (2.0 * ACDF_PI * (double)(range[0].high - range[0].low) * (share->all * height));
    if (pdf >= 3.402823466e38) return 3.402823466e38f;
    return (float)(pdf > least ? pdf : least);
}
/* The pdf of any cell of the fast shape; 0 where its probability is 0, as for half of all directions. No branch
 * tests for that: it would be guessed wrongly, after all else. */
ACDF_INLINE float acdf_local_fast_cell_pdf(const AcdfLocal* local, const AcdfGrid* grid, const AcdfRange range[2],
                                           const AcdfFastShare* share) {
    const double huge = share->of * 0x1p1000;
    return acdf_local_fast_at_least(local, grid, range, share, huge < 1.17549435e-38 ? huge : 1.17549435e-38);
}

/* The direction that rescaled random numbers lead to in a cell of such a probability. */
ACDF_INLINE AcdfDirectionSample acdf_local_fast_direction_sample(const AcdfLocal* local, const AcdfGrid* grid,
                                                                 const AcdfRange range[2], const double u[2],
                                                                 const AcdfFastShare* share) {
    AcdfDirectionSample out;
    if (!acdf_local_direction_by_tables(local, grid, range, u, out.direction))
        out = acdf_grid_position(grid, range, u, 1.0);
    out.pdf = acdf_local_fast_at_least(local, grid, range, share, 1.17549435e-38);
    return out;
}

/* acdf_local_row_sample of this shape. */
ACDF_INLINE AcdfDirectionSample acdf_local_fast_sample(const AcdfLocal* local, const AcdfLocalPoint* point,
                                                       double* u) {
    const AcdfGrid grid = acdf_environment_grid(&local->environment);
    AcdfRange range[2];
    AcdfFastShare share;
    acdf_sphere_ranges(grid.columns, grid.rows, range);
    share = acdf_local_fast_sample_cell(local, point, u, range);
    return acdf_local_fast_direction_sample(local, &grid, range, u, &share);
}

#ifdef __cplusplus
}
#endif
#endif
