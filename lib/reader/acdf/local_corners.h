/* The corners of the octahedron of normals around a normal, by runtime tables. Part of acdf/local.h. */
#ifndef ACDF_LOCAL_CORNERS_H
#define ACDF_LOCAL_CORNERS_H

#include <acdf/local_parts.h>

#ifdef __cplusplus
extern "C" {
#endif

/* Sets the normal in a scale. */
ACDF_INLINE void acdf_local_scaled(double scale, double length, AcdfLocalPoint* out) {
    out->scale = scale;
    out->length = scale * length;
}
ACDF_INLINE double acdf_local_length(const float normal[3]) {
    const double x = normal[0], y = normal[1], z = normal[2];
    return sqrt(x * x + y * y + z * z);
}

/* Sets the normal in the scale of the weights of its bins. */
ACDF_FN void acdf_local_normal(const AcdfLocal* local, const float normal[3], AcdfLocalPoint* out) {
    const double x = normal[0], y = normal[1], z = normal[2], length = acdf_local_length(normal);
    const double scale =
        local->subdivisions > 0 ? (double)local->subdivisions / (fabs(x) + fabs(y) + fabs(z)) : 1.0 / length;
    acdf_local_scaled(scale, length, out);
}

/* The number of a triangle: its octant, and the whole parts of |x| and |y| there, counted from the other side where
 * it stands on its tip (`down`). */
ACDF_INLINE int32_t acdf_local_facet(int32_t n, int32_t octant, int32_t x, int32_t y, int32_t down) {
    const int32_t back = down * (n - 1);
    return (octant * n + (back + x * (1 - 2 * down))) * n + (back + y * (1 - 2 * down));
}

/* The triangle of the octahedron that holds a normal, by tables, and the weights of the rows of its corners: those
 * of acdf_octahedral_bins. *scale becomes that of acdf_local_normal. Null on the edges of triangles, and where a
 * corner is not stored or has no light. */
ACDF_INLINE const AcdfFacet* acdf_local_find_facet(const AcdfLocal* local, const float normal[3], double weight[3],
                                                   double* scale) {
    const int32_t n = (int32_t)local->subdivisions;
    const AcdfFacet* facet;
    int32_t base[3], octant, down;
#ifdef ACDF_SSE2
    const __m128 given = _mm_setr_ps(normal[0], normal[1], normal[2], 0.0f);
    const __m128 size = _mm_andnot_ps(_mm_set1_ps(-0.0f), given);
    const __m128d edge = _mm_set1_pd((double)n), xy = _mm_cvtps_pd(size),
                  z = _mm_cvtps_pd(_mm_movehl_ps(size, size));
    const __m128d two = _mm_add_sd(_mm_add_sd(xy, _mm_unpackhi_pd(xy, xy)), z), sum = _mm_unpacklo_pd(two, two);
    const __m128d of_edge = _mm_div_pd(_mm_unpacklo_pd(z, edge), sum), last = _mm_mul_sd(of_edge, edge);
    const __m128d first = _mm_mul_pd(_mm_div_pd(xy, sum), edge);
    const __m128i whole = _mm_cvttpd_epi32(first);
    __m128d part, tip;
    if (!acdf_is_finite(_mm_cvtsd_f64(sum)) || !(_mm_cvtsd_f64(sum) > 0.0))
        return 0; /* as all are finite, or not */
    base[0] = _mm_cvtsi128_si32(whole);
    base[1] = _mm_cvtsi128_si32(_mm_srli_epi64(whole, 32));
    base[2] = _mm_cvttsd_si32(last);
    down = n - 1 - base[0] - base[1] - base[2];
    if ((uint32_t)down > 1) return 0;
    octant = _mm_movemask_ps(_mm_cmplt_ps(given, _mm_setzero_ps())); /* -0 is 0 */
    facet = acdf_local_facets(local->tables) + acdf_local_facet(n, octant, base[0], base[1], down);
    *scale = _mm_cvtsd_f64(_mm_unpackhi_pd(of_edge, of_edge));
    tip = _mm_set1_pd((double)down);
    part = _mm_andnot_pd(_mm_set1_pd(-0.0), _mm_sub_pd(tip, _mm_sub_pd(first, _mm_cvtepi32_pd(whole))));
    part = _mm_mul_pd(_mm_mul_pd(part, _mm_loadu_pd(facet->length)),
                      _mm_cvtps_pd(_mm_castsi128_ps(_mm_loadl_epi64((const __m128i*)(const void*)facet->share))));
    _mm_storeu_pd(weight, part);
    weight[2] = fabs((double)down - (_mm_cvtsd_f64(last) - base[2])) * facet->length[2] * (double)facet->share[2];
    return _mm_movemask_pd(_mm_cmpgt_pd(part, _mm_setzero_pd())) == 3 && weight[2] > 0.0 ? facet : 0;
#else
    const double ax = fabs((double)normal[0]), ay = fabs((double)normal[1]), az = fabs((double)normal[2]);
    const double sum = ax + ay + az;
    double a[3];
    int i;
    if (!acdf_is_finite(sum) || !(sum > 0.0)) return 0; /* as all three are finite, or not */
    a[0] = ax / sum * n;
    a[1] = ay / sum * n;
    a[2] = az / sum * n;
    for (i = 0; i < 3; ++i) base[i] = (int32_t)a[i];
    down = n - 1 - base[0] - base[1] - base[2];
    if ((uint32_t)down > 1) return 0;
    octant = (int32_t)(normal[0] < 0.0f) + 2 * (int32_t)(normal[1] < 0.0f) + 4 * (int32_t)(normal[2] < 0.0f);
    facet = acdf_local_facets(local->tables) + acdf_local_facet(n, octant, base[0], base[1], down);
    *scale = (double)n / sum;
    for (i = 0; i < 3; ++i)
        weight[i] = fabs((double)down - (a[i] - base[i])) * facet->length[i] * (double)facet->share[i];
    return weight[0] > 0.0 && weight[1] > 0.0 && weight[2] > 0.0 ? facet : 0;
#endif
}

/* Begins a point: nothing serves it. Rows are left open. */
ACDF_INLINE void acdf_local_no_rows(const float normal[3], AcdfLocalPoint* out) {
    out->what = ACDF_LOCAL_NOTHING;
    out->cells = out->portals = 0;
    acdf_as_given(normal, out->surface);
    out->scale = out->length = out->bright_tiles = out->sum = 0.0;
    out->mix.count = 0;
}

/* The environment's tree serves a normal: one of its bins is not stored. */
ACDF_INLINE int acdf_local_whole(const AcdfLocal* local, AcdfLocalPoint* out) {
    out->what = ACDF_LOCAL_TREE;
    out->by.root = local->environment.root;
    return 0;
}

#ifdef __cplusplus
}
#endif
#endif
