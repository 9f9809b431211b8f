/* Which stored views of a BRDF file serve a view, and with which weights (SPEC.md §11). */
#ifndef ACDF_BRDF_VIEW_H
#define ACDF_BRDF_VIEW_H

#include <acdf/brdf_tables.h>

#ifdef __cplusplus
extern "C" {
#endif

struct AcdfBrdfVectors;

typedef struct AcdfBrdf {
    AcdfBlend blend;              /* blend.tiles is null where each bin has a tree of its own */
    const uint8_t* tree;          /* chunk TREE */
    const AcdfBin* bins;          /* theta_count x phi_count */
    const AcdfViews* views;       /* chunk VIEW */
    const float* nodes;           /* theta_count, behind it */
    uint32_t columns;             /* axis 0, phi_h */
    uint32_t rows;                /* axis 1, cos_theta_h */
    double total;                 /* sum of the bins' albedos */
    const AcdfBrdfTables* tables; /* runtime tables; null: traverse the tree */
} AcdfBrdf;

/* What serves a view: which rows or which tree, and the turn that brings wo into the plane of x and z. */
typedef struct AcdfBrdfView {
    double wo[3];
    double turn[2]; /* x and y of a vector to which that turn brings x: wo's own where the file is isotropic */
    uint32_t root;  /* of the tree, where there are no rows */
    AcdfMixture mix;
    uint32_t lower;        /* of the two views around wo, where there are runtime tables */
    const uint8_t* row[2]; /* theirs */
    double pair[2];        /* and their weights */
    double albedo;
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
    const double x2 = acdf_view_square(cos_theta), x = acdf_brdf_root(x2);
    double low, high, t;
    node[0] = brdf->tables ? acdf_brdf_lower_view(brdf->tables, x, x2) : acdf_view_lower(brdf->nodes, count, x);
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

ACDF_FN void acdf_brdf_add(const AcdfBrdf* brdf, AcdfBrdfView* view, uint32_t index, double weight,
                           double* largest) {
    const AcdfBin* bin = &brdf->bins[index];
    view->albedo += weight * (double)bin->share * brdf->total;
    if (brdf->blend.tiles) {
        acdf_mixture_add(&view->mix, &brdf->blend, bin->root, weight * (double)bin->share);
    } else if (weight > *largest) {
        *largest = weight;
        view->root = bin->root;
    }
}

/* What runtime tables ask of a view: the two rows around it. Returns 0 for wo that are not unit vectors above the
 * surface. */
ACDF_INLINE int acdf_brdf_pair_view(const AcdfBrdf* brdf, const float wo[3], AcdfBrdfView* view) {
    const double* node;
    double x, x2, t;
    if (!acdf_brdf_turn(wo, 1, view)) return 0;
    x2 = acdf_view_square(view->wo[2]);
    x = acdf_brdf_root(x2);
    view->lower = acdf_brdf_lower_view(brdf->tables, x, x2);
    node = acdf_brdf_node(brdf->tables, view->lower); /* infinity and 0 stand behind the only one */
    t = (x - node[0]) / (node[2] - node[0]);
    t = t > 0.0 ? (t < 1.0 ? t : 1.0) : 0.0;
    view->pair[0] = (1.0 - t) * node[1];
    view->pair[1] = t * node[3];
    view->row[0] = acdf_blend_row(&brdf->blend, brdf->bins[view->lower].root);
    view->row[1] = acdf_blend_row(&brdf->blend, brdf->bins[view->lower + (brdf->views->theta_count > 1)].root);
    return 1;
}

/* Looks up the stored views around wo. Returns 0 for those that are not unit vectors above the surface. */
ACDF_FN int acdf_brdf_view(const AcdfBrdf* brdf, const float wo[3], AcdfBrdfView* view) {
    const uint32_t columns = brdf->views->phi_count;
    uint32_t node[2], column[2];
    double t, s = 0.0, largest = 0.0;
    view->lower = 0;
    view->row[0] = view->row[1] = 0;
    view->pair[0] = view->pair[1] = 0.0;
    if (brdf->tables ? !acdf_brdf_pair_view(brdf, wo, view) : !acdf_brdf_turn(wo, columns == 1, view)) return 0;
    view->mix.count = 0;
    view->albedo = 0.0;
    view->root = 0;
    t = acdf_view_nodes(brdf, view->wo[2], node);
    if (columns == 1) {
        acdf_brdf_add(brdf, view, node[0], 1.0 - t, &largest);
        acdf_brdf_add(brdf, view, node[1], t, &largest);
        return 1;
    }
    s = (double)columns *
        (0.5 + 0.5 * acdf_atan2pi(view->wo[1], view->wo[0])); /* column 0: phi = -pi, which is +pi */
    column[0] = (uint32_t)s;
    s -= (double)column[0];
    column[0] %= columns;
    column[1] = column[0] + 1 < columns ? column[0] + 1 : 0;
    acdf_brdf_add(brdf, view, node[0] * columns + column[0], (1.0 - t) * (1.0 - s), &largest);
    acdf_brdf_add(brdf, view, node[0] * columns + column[1], (1.0 - t) * s, &largest);
    acdf_brdf_add(brdf, view, node[1] * columns + column[0], t * (1.0 - s), &largest);
    acdf_brdf_add(brdf, view, node[1] * columns + column[1], t * s, &largest);
    return 1;
}

#ifdef __cplusplus
}
#endif
#endif
