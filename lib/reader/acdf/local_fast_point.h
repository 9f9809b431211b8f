/* Shading points of files of the fast shape (acdf/fast.h). Part of acdf/local.h. Where `draws` is 0 what only
 * samples need is left open: where rows are searched. */
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
    acdf_fast_set_row(&local->fast, &out->by.fast.mix, out->mix.count, row, draws);
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
    out->by.fast.facet = facet;
    acdf_local_scaled(scale, acdf_local_length(normal), out);
    acdf_fast_mix(weight, ACDF_FAST_ROWS, &out->by.fast.mix);
    return 1;
}

/* acdf_local_begin of files of the fast shape. */
ACDF_FN int acdf_local_begin_fast(const AcdfLocal* local, const float normal[3], AcdfLocalPoint* out) {
    AcdfNormalBins bins;
    int i;
    acdf_local_no_rows(normal, out);
    if (local->tables && local->tables->facets && acdf_local_fast_corners(local, out->surface, 1, out)) return 1;
    if (!acdf_local_bins(local, out->surface, &bins)) return 0;
    out->by.fast.facet = 0;
    for (i = 0; i < bins.count; ++i) {
        const AcdfBin* bin = &local->bins[bins.bin[i]];
        const double share = bins.weight[i] * (double)bin->share;
        if (bin->root == ACDF_NO_ROOT) return acdf_local_whole(local, out);
        if (share > 0.0) acdf_local_fast_row(local, bin->root, share, 1, out);
    }
    for (i = out->mix.count; i < ACDF_FAST_ROWS; ++i) {
        out->mix.weight[i] = 0.0;
        acdf_fast_set_row(&local->fast, &out->by.fast.mix, i, 0, 1);
    }
    acdf_local_normal(local, out->surface, out);
    acdf_fast_mix(out->mix.weight, out->mix.count, &out->by.fast.mix);
    return 1;
}

/* acdf_local_sum of the fast shape. */
ACDF_INLINE void acdf_local_fast_sum(const AcdfLocal* local, AcdfLocalPoint* out) {
    AcdfFastPoint* fast = &out->by.fast;
    const double mixture = out->mix.weight[0] + out->mix.weight[1] + out->mix.weight[2];
    const AcdfScaledNormal normal = acdf_local_scaled_normal(out);
    out->bright_tiles = fast->facet ? acdf_facet_bright_tiles(local, fast->facet, &normal)
                                    : acdf_pairs_weight(local, &normal, acdf_local_seen(local, 0));
    out->sum = out->bright_tiles + mixture;
    if (!(out->sum > 0.0)) return;
    fast->step = mixture > 0.0 ? 32767.0 * fast->mix.whole / mixture : 0.0;
    fast->unit = mixture > 0.0 ? mixture / (out->sum * (32767.0 * 255.0 * fast->mix.whole)) : 0.0;
    out->what = ACDF_LOCAL_FAST;
}

#ifdef __cplusplus
}
#endif
#endif
