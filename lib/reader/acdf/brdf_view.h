/* Which stored views of a BRDF file serve a view, and with which weights (SPEC.md §11). */
#ifndef ACDF_BRDF_VIEW_H
#define ACDF_BRDF_VIEW_H

#include <acdf/normal_rows.h>

#ifdef __cplusplus
extern "C" {
#endif

typedef struct AcdfBrdf {
    const AcdfHalvedTree* halved;        /* what all views share below their rows; null: `curves` samples them */
    const AcdfNormalRows* rows_of_views; /* beside it */
    const AcdfBin* bins;                 /* theta_count x phi_count */
    const AcdfViews* views;              /* chunk VIEW */
    const float* nodes;                  /* theta_count, behind it */
    uint32_t columns;                    /* steps of axis 0, phi_h */
    uint32_t rows;                       /* steps of 1 - cos(theta_h), in [0, 1] */
    double total;                        /* sum of the bins' albedos */
    const AcdfCurves* curves;            /* null: halvings; else */
    const uint8_t* tree;                 /* chunk TREE */
} AcdfBrdf;

/* What serves a view: which rows or which tree, and the turn that brings wo into the plane of x and z. */
typedef struct AcdfBrdfView {
    double wo[3];
    double turn[2]; /* x and y of a vector to which that turn brings x: wo's own where the file is isotropic */
    double albedo;
    AcdfRowMixture mix; /* of rows of halvings; without rows nothing is sampled */
    uint32_t root;      /* of curves: that of the nearest stored view in chunk TREE */
} AcdfBrdfView;

ACDF_FN int acdf_brdf_mirrored(const AcdfBrdf* brdf) { return (brdf->views->flags & ACDF_VIEWS_MIRRORED) != 0; }

/* The square root, without the branch to what sets errno. */
ACDF_INLINE double acdf_brdf_root(double x) {
#ifdef ACDF_SSE2
    const __m128d of = _mm_set_sd(x);
    return _mm_cvtsd_f64(_mm_sqrt_sd(of, of));
#else
    return sqrt(x);
#endif
}

/* A view's coordinate is sqrt(1 - cos(theta)): nearly proportional to the angle at normal incidence, and dense
 * enough at grazing. Its square: */
ACDF_FN double acdf_view_square(double cos_theta) { return cos_theta < 1.0 ? 1.0 - cos_theta : 0.0; }

/* The last node, but not the very last one, that is at most x; else 0. */
ACDF_FN uint32_t acdf_view_lower(const float* nodes, uint32_t count, double x) {
    const uint32_t last = count > 1 ? count - 2 : 0;
    uint32_t low = 0, i, more = 0;
    /* How many of nodes 1 to `last` are <= x: every eighth, then those between. No load waits for a comparison but
     * once, and no branch depends on them. */
    for (i = 8; i <= last; i += 8) low += 8u & (0u - (uint32_t)((double)nodes[i] <= x));
    for (i = 1; i < 8; ++i) {
        const uint32_t at = low + i < last ? low + i : last;
        more += (uint32_t)((double)nodes[at] <= x) & (uint32_t)(low + i <= last);
    }
    return low + more;
}

/* The nodes on both sides of a coordinate and how far it is from the lower to the upper one. */
ACDF_FN double acdf_view_nodes(const AcdfBrdf* brdf, double cos_theta, uint32_t node[2]) {
    const uint32_t count = brdf->views->theta_count;
    const double x = acdf_brdf_root(acdf_view_square(cos_theta));
    double low, high, t;
    node[0] = acdf_view_lower(brdf->nodes, count, x);
    node[1] = count > 1 ? node[0] + 1 : node[0];
    if (node[0] == node[1]) return 0.0;
    low = (double)brdf->nodes[node[0]];
    high = (double)brdf->nodes[node[1]];
    t = (x - low) / (high - low);
    return t > 0.0 ? (t < 1.0 ? t : 1.0) : 0.0;
}

/* The turn that brings wo into the plane of x and z. Returns 0 for wo that are not unit vectors above the surface.
 */
ACDF_INLINE int acdf_brdf_turn(const float wo[3], int isotropic, AcdfBrdfView* view) {
    float given[3];
    double x, y, z, sin2, length2;
    int turned;
    acdf_as_given(wo, given);
    x = given[0];
    y = given[1];
    z = given[2];
    sin2 = x * x + y * y;
    length2 = sin2 + z * z;
    turned = isotropic && sin2 > 0.0;
    view->wo[0] = x;
    view->wo[1] = y;
    view->wo[2] = z;
    view->turn[0] = turned ? x : 1.0;
    view->turn[1] = turned ? y : 0.0;
    return acdf_is_unit_square(length2) && z > 0.0;
}

/* Stored views around a view, and their weights by interpolation, which may be 0. */
typedef struct AcdfBrdfNear {
    uint32_t bin[ACDF_MOST_ROWS_MIXED];
    double weight[ACDF_MOST_ROWS_MIXED];
    int count;
} AcdfBrdfNear;

ACDF_INLINE void acdf_brdf_add(uint32_t bin, double weight, AcdfBrdfNear* near) {
    near->bin[near->count] = bin;
    near->weight[near->count++] = weight;
}

/* Those of an elevation at the azimuths on both sides of wo. */
ACDF_INLINE void acdf_brdf_add_around(const AcdfBrdf* brdf, const AcdfBrdfView* view, uint32_t node, double weight,
                                      AcdfBrdfNear* near) {
    const uint32_t columns = brdf->views->phi_count;
    /* Column 0: phi = -pi, which is +pi. */
    const double s = (double)columns * (0.5 + 0.5 * acdf_atan2pi(view->wo[1], view->wo[0]));
    const uint32_t whole = (uint32_t)s, column = whole % columns;
    const double part = s - (double)whole;
    acdf_brdf_add(node * columns + column, weight * (1.0 - part), near);
    acdf_brdf_add(node * columns + (column + 1 < columns ? column + 1 : 0), weight * part, near);
}

/* Begins a view: its frame and the stored views around it. Returns 0 for wo that are not unit vectors above the
 * surface. */
ACDF_INLINE int acdf_brdf_near(const AcdfBrdf* brdf, const float wo[3], AcdfBrdfView* view, AcdfBrdfNear* near) {
    const int isotropic = brdf->views->phi_count == 1;
    uint32_t node[2];
    double t;
    int k;
    if (!acdf_brdf_turn(wo, isotropic, view)) return 0;
    near->count = 0;
    view->mix.count = 0;
    view->albedo = 0.0;
    view->root = 0;
    t = acdf_view_nodes(brdf, view->wo[2], node);
    for (k = 0; k < 2; ++k) {
        const double weight = k ? t : 1.0 - t;
        if (isotropic) acdf_brdf_add(node[k], weight, near);
        else acdf_brdf_add_around(brdf, view, node[k], weight, near);
    }
    return 1;
}

/* What a stored view reflects, and adds to the albedo. */
ACDF_INLINE double acdf_brdf_reflected(const AcdfBrdf* brdf, const AcdfBrdfNear* near, int i, AcdfBrdfView* view) {
    const double reflected = near->weight[i] * (double)brdf->bins[near->bin[i]].share;
    view->albedo += reflected * brdf->total;
    return reflected;
}

/* Looks up the stored views around wo. Returns 0 for those that are not unit vectors above the surface. */
ACDF_FN int acdf_brdf_view(const AcdfBrdf* brdf, const float wo[3], AcdfBrdfView* view) {
    AcdfBrdfNear near;
    uint32_t row[ACDF_MOST_ROWS_MIXED];
    double weight[ACDF_MOST_ROWS_MIXED];
    int i, count = 0;
    ACDF_RETURN_CURVES(brdf, brdf_view(brdf, wo, view));
    if (!acdf_brdf_near(brdf, wo, view, &near)) return 0;
    for (i = 0; i < near.count; ++i) {
        const double reflected = acdf_brdf_reflected(brdf, &near, i, view);
        if (!(reflected > 0.0)) continue;
        row[count] = brdf->bins[near.bin[i]].root;
        weight[count++] = reflected;
    }
    if (count > 0) acdf_rows_mix(brdf->rows_of_views, row, weight, count, &view->mix);
    return 1;
}

#ifdef __cplusplus
}
#endif
#endif
