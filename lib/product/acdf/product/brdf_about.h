/* About how dense a view's samples are in many directions: where product sampling looks for light that is reflected
 * (acdf/product/product.h). Floats, an operation for all directions before the next one, so that compilers take
 * vectors. One freestanding header over acdf/brdf.h, valid C99, C++17 and CUDA/HIP/SYCL. */
#ifndef ACDF_BRDF_ABOUT_H
#define ACDF_BRDF_ABOUT_H

#include <acdf/product/vectors.h>

#ifdef __cplusplus
extern "C" {
#endif

enum { ACDF_ABOUT_MOST = 64 }; /* directions at once */
enum { ACDF_BRDF_FEWEST = 2 }; /* fewer are not worth vectors */

/* acdf_brdf_view_pdf of wi[i] into out[i], i < count: without vectors they wait for memory together. */
ACDF_FN void acdf_brdf_view_pdfs(const AcdfProductVectors* vectors, const AcdfBrdf* brdf, const AcdfBrdfView* view,
                                 const float (*wi)[3], size_t count, float* out) {
    enum { TOGETHER = 16 };
    AcdfBrdfPosition place[TOGETHER];
    uint32_t cell[TOGETHER];
    int found[TOGETHER];
    size_t first, i;
    if (!ACDF_SIDE_BY_SIDE || !brdf->tables || !brdf->tables->grid) {
        for (i = 0; i < count; ++i) out[i] = acdf_brdf_view_pdf(brdf, view, wi[i]);
        return;
    }
#if ACDF_SIDE_BY_SIDE
    if (vectors && count >= ACDF_BRDF_FEWEST) {
        vectors->brdf_pdf(brdf, view, wi, count, out);
        return;
    }
#endif
    for (first = 0; first < count; first += TOGETHER) {
        const size_t some = count - first < TOGETHER ? count - first : (size_t)TOGETHER;
        for (i = 0; i < some; ++i) {
            found[i] = acdf_brdf_pair_find(brdf, view, wi[first + i], &place[i], &cell[i]);
            if (found[i]) ACDF_PREFETCH(acdf_brdf_parts(brdf->tables, cell[i], view->lower));
        }
        for (i = 0; i < some; ++i)
            out[first + i] = found[i] ? acdf_brdf_pair_found(brdf, view, cell[i], &place[i]) : 0.0f;
    }
}

/* acdf_brdf_view_sample of u[i] into out[i], i < count, to the bit. */
ACDF_FN void acdf_brdf_view_samples(const AcdfProductVectors* vectors, const AcdfBrdf* brdf,
                                    const AcdfBrdfView* view, const double (*u)[2], size_t count,
                                    AcdfDirectionSample* out) {
    size_t i;
#if ACDF_SIDE_BY_SIDE
    if (vectors && count >= ACDF_BRDF_FEWEST) {
        vectors->brdf_sample(brdf, view, u, count, out);
        return;
    }
#endif
    for (i = 0; i < count; ++i) out[i] = acdf_brdf_view_sample(brdf, view, u[i][0], u[i][1]);
}

/* Of each direction: what its half-vector is, and where it lies. */
typedef struct AcdfBrdfAbout {
    float half[3][ACDF_ABOUT_MOST];
    float length[ACDF_ABOUT_MOST], dot[ACDF_ABOUT_MOST]; /* of wo + wi, as AcdfBrdfPosition has them */
    int32_t step[2][ACDF_ABOUT_MOST];                    /* of the guides of borders */
    int32_t column[ACDF_ABOUT_MOST];                     /* of the grid of squares */
    float share[ACDF_ABOUT_MOST], area[ACDF_ABOUT_MOST]; /* of the cell */
} AcdfBrdfAbout;

/* Half-vectors, unnormalised. */
ACDF_INLINE void acdf_about_halves(const AcdfBrdfView* view, const float (*wi)[3], uint32_t count,
                                   AcdfBrdfAbout* a) {
    const float wo[3] = {(float)view->wo[0], (float)view->wo[1], (float)view->wo[2]};
    const uint32_t all = (count + 3u) & ~3u; /* roots are sampled four at a time */
    uint32_t i;
    int k;
    for (i = 0; i < count; ++i)
        for (k = 0; k < 3; ++k) a->half[k][i] = wo[k] + wi[i][k];
    for (; i < all; ++i)
        for (k = 0; k < 3; ++k) a->half[k][i] = wo[k];
    for (i = 0; i < all; ++i) {
        const float x = a->half[0][i], y = a->half[1][i], z = a->half[2][i];
        a->length[i] = x * x + y * y + z * z;
        a->dot[i] = fabsf(wo[0] * x + wo[1] * y + wo[2] * z);
    }
    for (i = 0; i < all; i += 4) {
#ifdef ACDF_SSE2
        _mm_storeu_ps(a->length + i, _mm_sqrt_ps(_mm_loadu_ps(a->length + i)));
#else
        uint32_t lane;
        for (lane = i; lane < i + 4; ++lane) a->length[lane] = sqrtf(a->length[lane]);
#endif
    }
}

/* The step of a guide that holds a position: its exponent, and the first bits behind the point. */
ACDF_INLINE int32_t acdf_about_step(float position) {
    int32_t bits;
    position = position > 1.0f ? position : 1.0f;
    memcpy(&bits, &position, sizeof bits);
    return (bits >> (23 - ACDF_BORDER_STEP_BITS)) - (127 << ACDF_BORDER_STEP_BITS);
}

/* The last position of an axis, or a float before it. */
ACDF_INLINE float acdf_about_last(uint32_t resolution) {
    const float last = (float)(int32_t)(resolution - 1) * (1.0f - 0x1p-23f);
    return last > 1.0f ? last : 1.0f;
}

ACDF_INLINE float acdf_about_bounded(float position, float last) {
    const float positive = position > 0.0f ? position : 0.0f; /* NaN, too */
    return positive < last ? positive : last;
}

/* Azimuths and heights, as acdf_brdf_position has them. The arc tangent is that of Abramowitz and Stegun, 4.4.47,
 * over pi: within 1e-5. */
ACDF_INLINE void acdf_about_positions(const AcdfBrdf* brdf, const AcdfBrdfView* view, uint32_t count,
                                      AcdfBrdfAbout* a) {
    const float turn0 = (float)view->turn[0], turn1 = (float)view->turn[1];
    const float columns = (float)brdf->columns, rows = (float)brdf->rows;
    const float last0 = acdf_about_last(brdf->columns), last1 = acdf_about_last(brdf->rows);
    const int mirrored = acdf_brdf_mirrored(brdf);
    const float origin = mirrored ? 0.0f : 0.5f, even = mirrored ? 1.0f : 0.0f, odd = mirrored ? 0.0f : 0.5f;
    float place[2][ACDF_ABOUT_MOST];
    uint32_t i;
    for (i = 0; i < count; ++i) {
        const float x = a->half[0][i], y = a->half[1][i], z = a->half[2][i], below = copysignf(1.0f, z);
        const float hx = below * (turn0 * x + turn1 * y), hy = below * (turn0 * y - turn1 * x);
        const float ax = fabsf(hx), ay = fabsf(hy), high = ax > ay ? ax : ay, low = ax < ay ? ax : ay;
        const float t = low / (high + 1e-30f), t2 = t * t;
        const float arc =
            t * (0.318267f + t2 * (-0.105138f + t2 * (0.057341f + t2 * (-0.027099f + t2 * 0.006632f))));
        const float quarter = 0.25f + copysignf(1.0f, ax - ay) * (arc - 0.25f);
        const float phi = 0.5f + copysignf(1.0f, hx) * (quarter - 0.5f);
        place[0][i] = columns * (origin + phi * (even + copysignf(odd, hy)));
        place[1][i] = rows * ((x * x + y * y) / (a->length[i] * (a->length[i] + fabsf(z))));
    }
    for (i = 0; i < count; ++i) {
        const float position = acdf_about_bounded(place[0][i], last0);
        a->step[0][i] = acdf_about_step(position);
        a->column[i] = (int32_t)position;
    }
    for (i = 0; i < count; ++i) a->step[1][i] = acdf_about_step(acdf_about_bounded(place[1][i], last1));
}

/* How many borders lie at or below a position: of those behind the first one of its step, up to two. */
ACDF_INLINE uint32_t acdf_about_borders(const int32_t* borders, uint32_t guided, int32_t position) {
    return guided + (uint32_t)(borders[guided] <= position) + (uint32_t)(borders[guided + 1] <= position);
}

/* The cells there, and what the rows around the view give to them. */
ACDF_INLINE void acdf_about_cells(const AcdfBrdf* brdf, const AcdfBrdfView* view, uint32_t count,
                                  AcdfBrdfAbout* a) {
    const AcdfBrdfTables* tables = brdf->tables;
    const int32_t* borders = (const int32_t*)acdf_brdf_words(tables, tables->borders[0]);
    const uint16_t* guide0 = (const uint16_t*)acdf_brdf_words(tables, tables->border_guides[0]);
    const uint16_t* guide1 = (const uint16_t*)acdf_brdf_words(tables, tables->border_guides[1]);
    const uint16_t* grid = (const uint16_t*)acdf_brdf_words(tables, tables->grid);
    const double sum = view->pair[0] + view->pair[1];
    const double weight[2] = {sum > 0.0 ? view->pair[0] / sum : 0.0, sum > 0.0 ? view->pair[1] / sum : 0.0};
    uint32_t i;
    for (i = 0; i < count; ++i) {
        const uint32_t column = acdf_about_borders(borders, guide0[a->step[0][i]], a->column[i]);
        const uint32_t row = guide1[a->step[1][i]];
        const uint32_t cell = grid[row * tables->columns_between + column];
        const double* part = acdf_brdf_parts(tables, cell, view->lower);
        a->share[i] = (float)(weight[0] * part[0] + weight[1] * part[1]);
        a->area[i] = (float)acdf_brdf_area(tables, cell);
    }
}

/* About acdf_brdf_view_pdfs, in a fraction of the time: of cells that lie less than a sixteenth of their height, or
 * one position, before it. Azimuths are more exact: beyond some of them nothing is reflected. At most 1e30; 0
 * where there are none, never NaN. */
ACDF_OUTLINE_ON_CPU void acdf_brdf_view_pdfs_about(const AcdfProductVectors* vectors, const AcdfBrdf* brdf,
                                                   const AcdfBrdfView* view, const float (*wi)[3], size_t count,
                                                   float* out) {
    const float scale = (float)((double)brdf->columns * (double)brdf->rows / (8.0 * ACDF_PI));
    AcdfBrdfAbout a;
    size_t first, i;
    if (!brdf->tables || !brdf->tables->grid) {
        acdf_brdf_view_pdfs(vectors, brdf, view, wi, count, out);
        return;
    }
    for (first = 0; first < count; first += ACDF_ABOUT_MOST) {
        const size_t left = count - first, some = left < ACDF_ABOUT_MOST ? left : (size_t)ACDF_ABOUT_MOST;
        acdf_about_halves(view, wi + first, (uint32_t)some, &a);
        acdf_about_positions(brdf, view, (uint32_t)some, &a);
        acdf_about_cells(brdf, view, (uint32_t)some, &a);
        for (i = 0; i < some; ++i) { /* as acdf_brdf_mean_pdf */
            const float pdf = scale * a.share[i] * a.length[i] / (a.dot[i] * a.area[i]);
            const float positive = pdf > 0.0f ? pdf : 0.0f; /* NaN is not */
            out[first + i] = positive < 1e30f ? positive : 1e30f;
        }
    }
}

#ifdef __cplusplus
}
#endif
#endif
