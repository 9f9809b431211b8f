/* Shading points of files of the fast shape (acdf/fast.h). Part of acdf/local.h. Where `samples` is 0 what only
 * samples need is left open: where rows are searched, and the weight of each light. Points without are of facets.
 */
#ifndef ACDF_LOCAL_FAST_POINT_H
#define ACDF_LOCAL_FAST_POINT_H

#include <acdf/bright_tiles.h>
#include <acdf/local_corners.h>

#ifdef __cplusplus
extern "C" {
#endif

/* A row of the fast shape, and what of the mixture it weighs. */
ACDF_INLINE void acdf_local_fast_row(const AcdfLocal* local, uint32_t row, double weight, const int draws,
                                     AcdfLocalPoint* out) {
    out->mix.weight[out->mix.count] = weight;
    acdf_fast_set_row(&local->fast, &out->fast, out->mix.count, row, draws);
    ++out->mix.count;
}

/* acdf_local_table_rows of the fast shape. */
ACDF_INLINE int acdf_local_fast_corners(const AcdfLocal* local, const float normal[3], const int draws,
                                        AcdfLocalPoint* out) {
    double weight[3], scale;
    const AcdfFacet* facet = acdf_local_find_facet(local, normal, weight, &scale);
    int i;
    if (!facet) return 0;
    for (i = 0; i < 3; ++i) acdf_local_fast_row(local, facet->row[i], weight[i], draws, out);
    acdf_local_set_facet(normal, facet, scale, out);
    acdf_fast_mix(weight, ACDF_FAST_ROWS, &out->fast);
    return 1;
}

/* acdf_local_begin of files of the fast shape. */
ACDF_FN int acdf_local_begin_fast(const AcdfLocal* local, const float normal[3], AcdfLocalPoint* out) {
    AcdfNormalBins bins;
    int i;
    acdf_local_no_rows(normal, out);
    if (local->tables && local->tables->facets && acdf_local_fast_corners(local, out->surface, 1, out)) return 1;
    if (!acdf_local_bins(local, out->surface, &bins)) return 0;
    for (i = 0; i < bins.count; ++i) {
        const AcdfBin* bin = &local->bins[bins.bin[i]];
        const double share = bins.weight[i] * (double)bin->share;
        if (bin->root == ACDF_NO_ROOT) return acdf_local_whole(local, out);
        if (share > 0.0) acdf_local_fast_row(local, bin->root, share, 1, out);
    }
    for (i = out->mix.count; i < ACDF_FAST_ROWS; ++i) {
        out->mix.weight[i] = 0.0;
        acdf_fast_set_row(&local->fast, &out->fast, i, 0, 1);
    }
    acdf_local_normal(local, out->surface, out);
    acdf_fast_mix(out->mix.weight, out->mix.count, &out->fast);
    return 1;
}

/* Weighs the bright tiles of the fast shape that the normal may see: each, the sums up to each, and all. Sums are
 * made by twos, so that few wait for each other. */
ACDF_INLINE void acdf_local_fast_bright_tiles(const AcdfLocal* local, AcdfLocalPoint* out) {
    const double inverse = 1.0 / out->length;
    double end = 0.0, sum[2] = {0.0, 0.0};
    AcdfBrightTilePair pair;
    uint32_t k;
    for (k = 0; k < local->bright_tile_count; k += 2) {
        uint32_t i;
        acdf_local_bright_tile_pair(local, k, &pair);
        for (i = 0; i < 2; ++i) sum[i] += out->light[k + i] = acdf_pair_weight(out, &pair, i, inverse);
        out->light_end[k] = out->light[k] + end;
        end = out->light_end[k + 1] = (out->light[k + 1] + out->light[k]) + end;
        out->pair[k / 2] = (uint8_t)(k / 2);
    }
    out->lit = k;
    out->bright_tiles = sum[0] + sum[1];
}
/* The same by tables; where a facet is known, all as acdf_facet_bright_tiles returns it. */
ACDF_INLINE void acdf_local_tabled_bright_tiles(const AcdfLocal* local, AcdfLocalPoint* out) {
#ifdef ACDF_SSE2
    const AcdfBrightTilePair* pair = acdf_local_bright_tiles(local->tables);
    const AcdfHorizon horizon = acdf_horizon(out);
    const __m128d inverse = _mm_set1_pd(1.0 / out->length), zero = _mm_setzero_pd();
    const AcdfFacet* facet = out->facet;
    const uint32_t others = facet ? facet->others : 0xFFFFFFFFu;
    uint32_t left = facet                          ? facet->seen
                    : local->bright_tile_count > 0 ? 0xFFFFFFFFu >> (31 - (local->bright_tile_count - 1) / 2)
                                                   : 0;
    __m128d end = zero, sum = zero;
    out->lit = 0;
    for (; left; left &= left - 1) {
        const uint32_t k = acdf_lowest_bit(left);
        const __m128d both = acdf_pair_weights(&horizon, pair + k, inverse);
        const __m128i is_other = _mm_set1_epi32(-(int32_t)(others >> k & 1u));
        _mm_storeu_pd(&out->light[out->lit], both);
        sum = _mm_add_pd(sum, _mm_and_pd(both, _mm_castsi128_pd(is_other)));
        end = _mm_add_pd(_mm_add_pd(both, _mm_unpacklo_pd(zero, both)), end);
        _mm_storeu_pd(&out->light_end[out->lit], end); /* at once, as samples read them */
        end = _mm_unpackhi_pd(end, end);
        out->pair[out->lit / 2] = (uint8_t)k;
        out->lit += 2;
    }
    out->bright_tiles =
        (facet ? acdf_facet_whole(out) : 0.0) + _mm_cvtsd_f64(_mm_add_sd(sum, _mm_unpackhi_pd(sum, sum)));
#else
    acdf_local_fast_bright_tiles(local, out);
    if (out->facet) out->bright_tiles = acdf_facet_bright_tiles(local, out);
#endif
}

/* acdf_local_sum of the fast shape. */
ACDF_INLINE void acdf_local_fast_sum(const AcdfLocal* local, const int draws, AcdfLocalPoint* out) {
    const double mixture = out->mix.weight[0] + out->mix.weight[1] + out->mix.weight[2];
    if (!local->tables) acdf_local_fast_bright_tiles(local, out);
    else if (draws) acdf_local_tabled_bright_tiles(local, out);
    else if (out->facet) out->bright_tiles = acdf_facet_bright_tiles(local, out);
    out->sum = out->bright_tiles + mixture;
    if (!(out->sum > 0.0)) return;
    out->step = mixture > 0.0 ? 32767.0 * out->fast.whole / mixture : 0.0;
    out->unit = mixture > 0.0 ? mixture / (out->sum * (32767.0 * 255.0 * out->fast.whole)) : 0.0;
    out->what = ACDF_LOCAL_FAST;
}

#ifdef __cplusplus
}
#endif
#endif
