/* Weights of the bright tiles of a local environment map at a point (SPEC.md §10.3). Part of acdf/local.h. */
#ifndef ACDF_BRIGHT_TILES_H
#define ACDF_BRIGHT_TILES_H

#include <acdf/local_parts.h>

#ifdef __cplusplus
extern "C" {
#endif

/* A normal in the scale of the weights of the rows around it. */
typedef struct AcdfScaledNormal {
    double normal[3], length;
} AcdfScaledNormal;

ACDF_INLINE AcdfScaledNormal acdf_local_scaled_normal(const AcdfLocalPoint* point) {
    AcdfScaledNormal out;
    int i;
    for (i = 0; i < 3; ++i) out.normal[i] = point->scale * (double)point->surface[i];
    out.length = point->length;
    return out;
}

/* Weight of a bright tile: its share times the mean over it of the cosine above the horizon. It is taken as spread
 * evenly from -radius to radius around its middle, so that no weight is 0 where any of it can be seen. */
ACDF_INLINE double acdf_cap_weight(const AcdfScaledNormal* at, double x, double y, double z, double radius,
                                   double share) {
    const double height = at->normal[0] * x + at->normal[1] * y + at->normal[2] * z;
    radius *= at->length;
    /* The horizon rarely cuts a bright tile, and whether one is above it cannot be predicted: no branch. */
    if (fabs(height) < radius) return share * ((height + radius) * (height + radius) / (4.0 * radius));
    return share * (0.5 * (height + fabs(height))); /* 0 below, exactly the height above */
}
ACDF_FN double acdf_bright_tile_weight(const AcdfBrightTile* light, const AcdfScaledNormal* at) {
    return acdf_cap_weight(at, (double)light->direction[0], (double)light->direction[1],
                           (double)light->direction[2], (double)light->radius, (double)light->share);
}

/* What weights of bright tiles need of a point, and those of two bright tiles. */
#ifdef ACDF_SSE2
typedef __m128d AcdfTwoWeights;
typedef struct AcdfHorizon {
    __m128d normal[3], length;
} AcdfHorizon;

ACDF_INLINE AcdfHorizon acdf_horizon(const AcdfScaledNormal* at) {
    AcdfHorizon out;
    int i;
    for (i = 0; i < 3; ++i) out.normal[i] = _mm_set1_pd(at->normal[i]);
    out.length = _mm_set1_pd(at->length);
    return out;
}
ACDF_INLINE AcdfTwoWeights acdf_bright_tile_pair_weights(const AcdfBrightTilePair* pair,
                                                         const AcdfHorizon* horizon) {
    const __m128d height = _mm_add_pd(_mm_add_pd(_mm_mul_pd(horizon->normal[0], _mm_loadu_pd(pair->direction[0])),
                                                 _mm_mul_pd(horizon->normal[1], _mm_loadu_pd(pair->direction[1]))),
                                      _mm_mul_pd(horizon->normal[2], _mm_loadu_pd(pair->direction[2])));
    const __m128d radius = _mm_mul_pd(_mm_loadu_pd(pair->radius), horizon->length);
    const __m128d size = _mm_andnot_pd(_mm_set1_pd(-0.0), height), above = _mm_add_pd(height, radius);
    const __m128d cut = _mm_div_pd(_mm_mul_pd(above, above), _mm_mul_pd(_mm_set1_pd(4.0), radius));
    const __m128d whole = _mm_mul_pd(_mm_set1_pd(0.5), _mm_add_pd(height, size));
    const __m128d is_cut = _mm_cmplt_pd(size, radius);
    const __m128d mean = _mm_or_pd(_mm_and_pd(is_cut, cut), _mm_andnot_pd(is_cut, whole));
    return _mm_mul_pd(_mm_loadu_pd(pair->share), mean);
}
ACDF_INLINE void acdf_store_weights(AcdfTwoWeights weights, double out[2]) { _mm_storeu_pd(out, weights); }
#else
typedef struct AcdfTwoWeights {
    double of[2];
} AcdfTwoWeights;
typedef struct AcdfHorizon {
    const AcdfScaledNormal* at;
} AcdfHorizon;

ACDF_INLINE AcdfHorizon acdf_horizon(const AcdfScaledNormal* at) {
    AcdfHorizon out;
    out.at = at;
    return out;
}
ACDF_INLINE AcdfTwoWeights acdf_bright_tile_pair_weights(const AcdfBrightTilePair* pair,
                                                         const AcdfHorizon* horizon) {
    AcdfTwoWeights out;
    int i;
    for (i = 0; i < 2; ++i)
        out.of[i] = acdf_cap_weight(horizon->at, pair->direction[0][i], pair->direction[1][i],
                                    pair->direction[2][i], pair->radius[i], pair->share[i]);
    return out;
}
ACDF_INLINE void acdf_store_weights(AcdfTwoWeights weights, double out[2]) {
    out[0] = weights.of[0];
    out[1] = weights.of[1];
}
#endif

/* The weight of bright tile `k`. */
ACDF_FN double acdf_local_bright_tile_weight(const AcdfLocal* local, const AcdfLocalPoint* point, uint32_t k) {
    const AcdfScaledNormal at = acdf_local_scaled_normal(point);
    return acdf_bright_tile_weight(&local->bright_tiles[k], &at);
}

/* Two bright tiles, from number k on. */
ACDF_FN void acdf_local_bright_tile_pair(const AcdfLocal* local, uint32_t k, AcdfBrightTilePair* out) {
    uint32_t i;
    int axis;
    for (i = 0; i < 2; ++i) {
        const AcdfBrightTile* light = &local->bright_tiles[k + i < local->bright_tile_count ? k + i : k];
        for (axis = 0; axis < 3; ++axis) out->direction[axis][i] = (double)light->direction[axis];
        out->radius[i] = (double)light->radius;
        out->share[i] = k + i < local->bright_tile_count ? (double)light->share : 0.0;
        out->quarter[i] = out->share[i] / (4.0 * out->radius[i]);
    }
}

/* acdf_cap_weight of light i of two without a quotient; `inverse` is that of the point's
 * length. */
ACDF_INLINE double acdf_pair_weight(const AcdfScaledNormal* at, const AcdfBrightTilePair* pair, uint32_t i,
                                    double inverse) {
    const double height = at->normal[0] * pair->direction[0][i] + at->normal[1] * pair->direction[1][i] +
                          at->normal[2] * pair->direction[2][i];
    const double radius = pair->radius[i] * at->length, above = height + radius;
    return fabs(height) < radius ? above * above * (pair->quarter[i] * inverse)
                                 : pair->share[i] * (height > 0.0 ? height : 0.0);
}
#ifdef ACDF_SSE2
/* acdf_pair_weight of both bright tiles of a pair. */
ACDF_INLINE __m128d acdf_pair_weights(const AcdfHorizon* horizon, const AcdfBrightTilePair* pair, __m128d inverse) {
    const __m128d height = _mm_add_pd(_mm_add_pd(_mm_mul_pd(horizon->normal[0], _mm_loadu_pd(pair->direction[0])),
                                                 _mm_mul_pd(horizon->normal[1], _mm_loadu_pd(pair->direction[1]))),
                                      _mm_mul_pd(horizon->normal[2], _mm_loadu_pd(pair->direction[2])));
    const __m128d radius = _mm_mul_pd(_mm_loadu_pd(pair->radius), horizon->length);
    const __m128d size = _mm_andnot_pd(_mm_set1_pd(-0.0), height), above = _mm_add_pd(height, radius);
    const __m128d cut = _mm_mul_pd(_mm_mul_pd(above, above), _mm_mul_pd(_mm_loadu_pd(pair->quarter), inverse));
    const __m128d whole = _mm_mul_pd(_mm_loadu_pd(pair->share), _mm_max_pd(height, _mm_setzero_pd()));
    const __m128d is_cut = _mm_cmplt_pd(size, radius);
    return _mm_or_pd(_mm_and_pd(is_cut, cut), _mm_andnot_pd(is_cut, whole));
}
#endif

/* The sum of the weights of pairs, a bit each, by tables. */
ACDF_INLINE double acdf_pairs_weight(const AcdfLocal* local, const AcdfScaledNormal* at, uint32_t left) {
    const double inverse = 1.0 / at->length;
    const AcdfBrightTilePair* pairs = acdf_local_bright_tiles(local->tables);
#ifdef ACDF_SSE2
    const AcdfHorizon horizon = acdf_horizon(at);
    __m128d sum = _mm_setzero_pd();
    for (; left; left &= left - 1)
        sum = _mm_add_pd(sum, acdf_pair_weights(&horizon, pairs + acdf_lowest_bit(left), _mm_set1_pd(inverse)));
    return _mm_cvtsd_f64(_mm_add_sd(sum, _mm_unpackhi_pd(sum, sum)));
#else
    double sum[2] = {0.0, 0.0};
    for (; left; left &= left - 1) {
        const AcdfBrightTilePair* of = pairs + acdf_lowest_bit(left);
        sum[0] += acdf_pair_weight(at, of, 0, inverse);
        sum[1] += acdf_pair_weight(at, of, 1, inverse);
    }
    return sum[0] + sum[1];
#endif
}

/* The sum of the weights of all bright tiles at a normal whose facet is known: of those that are above all horizons
 * there, and of others. */
ACDF_INLINE double acdf_facet_bright_tiles(const AcdfLocal* local, const AcdfFacet* facet,
                                           const AcdfScaledNormal* at) {
    const double* whole = facet->whole;
    return at->normal[0] * whole[0] + at->normal[1] * whole[1] + at->normal[2] * whole[2] +
           acdf_pairs_weight(local, at, facet->others);
}

#ifdef __cplusplus
}
#endif
#endif
