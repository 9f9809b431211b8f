/* Shading points of a local environment map: what serves a normal (SPEC.md §6.7). Part of acdf/local.h. */
#ifndef ACDF_LOCAL_POINT_H
#define ACDF_LOCAL_POINT_H

#include <acdf/fast.h>
#include <acdf/local_tables.h>
#include <acdf/normals.h>
#include <acdf/portals.h>

#ifdef __cplusplus
extern "C" {
#endif

struct AcdfLocalVectors;

typedef struct AcdfLocal {
    AcdfBlend blend;             /* blend.tiles is null where each bin has a tree of its own */
    AcdfEnvironment environment; /* the 2D table that is always there */
    const AcdfBin* bins;
    const AcdfLight* lights; /* of the blend */
    uint32_t light_count;
    uint32_t subdivisions; /* of an octahedron's edge; 0: bins are cells of a lat-long grid */
    uint32_t columns;      /* of that grid */
    uint32_t rows;
    double cosine_share;
    const AcdfLocalTables* tables;          /* runtime tables; null: splits are walked */
    const AcdfCompany* company;             /* null: to be used alone */
    AcdfPlaceTable places;                  /* its header is null where places are not told apart */
    AcdfPortalTable portals;                /* its header is null where there are none */
    const struct AcdfLocalVectors* vectors; /* acdf/cut_wave.h; null: several calls are made by scalar code */
    AcdfFast fast;                          /* the fast shape: the blend has no rows then, and roots are of grids */
} AcdfLocal;

ACDF_FN int acdf_local_bins(const AcdfLocal* local, const float normal[3], AcdfNormalBins* out) {
    if (local->subdivisions > 0) return acdf_octahedral_bins(local->subdivisions, normal, out);
    return acdf_latlong_bins(local->columns, local->rows, normal, out);
}

/* What serves a normal: nothing, a tree of its own (or the environment's), or lights and what bins share, in either
 * shape. Made once for a shading point, it serves all samples there. */
enum { ACDF_LOCAL_NOTHING, ACDF_LOCAL_TREE, ACDF_LOCAL_BLEND, ACDF_LOCAL_FAST };

typedef struct AcdfLocalPoint {
    int what;
    uint32_t root;    /* of the tree */
    float surface[3]; /* the normal as given */
    double normal[3]; /* with the weights of the mixture: the weighted sum of its bins' corners */
    double length;    /* of that */
    AcdfMixture mix;  /* of the blend; the weights are those that reach the place */
    const uint8_t* codes[ACDF_MAX_ROWS_MIXED]; /* the rows in the runtime tables, where there are such */
    const double* parts[ACDF_MAX_ROWS_MIXED];  /* what they give to each tile, where there are such */
    double lights;                             /* sum of the weights of the lights */
    double sum;                                /* of all weights */
    AcdfPlaceMixture place;                    /* empty: the position is not known, or does not matter */
    AcdfWindows windows;                       /* as the place sees them; its count is 0 where there are none */
    AcdfFastMixture fast;                      /* of the fast shape; `mix` has the weights, too */
} AcdfLocalPoint;

/* Weight of a light: its share times the mean over it of the cosine above the horizon. It is taken as spread evenly
 * from -radius to radius around its middle, so that no weight is 0 where any of it can be seen. */
ACDF_INLINE double acdf_cap_weight(const AcdfLocalPoint* point, double x, double y, double z, double radius,
                                   double share) {
    const double height = point->normal[0] * x + point->normal[1] * y + point->normal[2] * z;
    radius *= point->length;
    /* The horizon rarely cuts a light, and whether one is above it is not to be guessed: no branch. */
    if (fabs(height) < radius) return share * ((height + radius) * (height + radius) / (4.0 * radius));
    return share * (0.5 * (height + fabs(height))); /* 0 below, exactly the height above */
}
ACDF_FN double acdf_light_weight(const AcdfLight* light, const AcdfLocalPoint* point) {
    return acdf_cap_weight(point, (double)light->direction[0], (double)light->direction[1],
                           (double)light->direction[2], (double)light->radius, (double)light->share);
}

/* The same of two lights. */
ACDF_INLINE void acdf_light_pair_weights(const AcdfLightPair* pair, const AcdfLocalPoint* point, double weight[2]) {
#ifdef ACDF_SSE2
    const __m128d height =
        _mm_add_pd(_mm_add_pd(_mm_mul_pd(_mm_set1_pd(point->normal[0]), _mm_loadu_pd(pair->direction[0])),
                              _mm_mul_pd(_mm_set1_pd(point->normal[1]), _mm_loadu_pd(pair->direction[1]))),
                   _mm_mul_pd(_mm_set1_pd(point->normal[2]), _mm_loadu_pd(pair->direction[2])));
    const __m128d radius = _mm_mul_pd(_mm_loadu_pd(pair->radius), _mm_set1_pd(point->length));
    const __m128d size = _mm_andnot_pd(_mm_set1_pd(-0.0), height), above = _mm_add_pd(height, radius);
    const __m128d cut = _mm_div_pd(_mm_mul_pd(above, above), _mm_mul_pd(_mm_set1_pd(4.0), radius));
    const __m128d whole = _mm_mul_pd(_mm_set1_pd(0.5), _mm_add_pd(height, size));
    const __m128d is_cut = _mm_cmplt_pd(size, radius);
    const __m128d mean = _mm_or_pd(_mm_and_pd(is_cut, cut), _mm_andnot_pd(is_cut, whole));
    _mm_storeu_pd(weight, _mm_mul_pd(_mm_loadu_pd(pair->share), mean));
#else
    int i;
    for (i = 0; i < 2; ++i)
        weight[i] = acdf_cap_weight(point, pair->direction[0][i], pair->direction[1][i], pair->direction[2][i],
                                    pair->radius[i], pair->share[i]);
#endif
}

/* The same of light `k` as its place sees it. */
ACDF_FN double acdf_local_light_weight(const AcdfLocal* local, const AcdfLocalPoint* point, uint32_t k) {
    const double weight = acdf_light_weight(&local->lights[k], point);
    return point->place.count > 0 ? weight * acdf_place_visibility(&point->place, 1 + k) : weight;
}

/* The bin of the largest weight. */
ACDF_FN uint32_t acdf_nearest_bin(const AcdfNormalBins* bins) {
    int i, nearest = 0;
    for (i = 1; i < bins->count; ++i)
        if (bins->weight[i] > bins->weight[nearest]) nearest = i;
    return bins->bin[nearest];
}

/* Sets the normal in the scale of the weights of its bins. */
ACDF_FN void acdf_local_normal(const AcdfLocal* local, const float normal[3], AcdfLocalPoint* out) {
    const double x = normal[0], y = normal[1], z = normal[2], length = sqrt(x * x + y * y + z * z);
    const double scale =
        local->subdivisions > 0 ? (double)local->subdivisions / (fabs(x) + fabs(y) + fabs(z)) : 1.0 / length;
    out->normal[0] = scale * x;
    out->normal[1] = scale * y;
    out->normal[2] = scale * z;
    out->length = scale * length;
}

/* Where the row of the next one that is added to the mixture goes. */
ACDF_INLINE void acdf_local_tabled_row(const AcdfLocal* local, uint32_t row, AcdfLocalPoint* out) {
    const AcdfLocalTables* tables = local->tables;
    out->codes[out->mix.count] = acdf_tile_row(acdf_local_words(tables), &tables->tiles, row);
    ACDF_PREFETCH(out->codes[out->mix.count]);
    if (tables->parts) out->parts[out->mix.count] = acdf_local_parts(tables, row, local->blend.tiles->tile_count);
}

/* The corners of the triangle of the octahedron that holds a normal, by tables, and the weights of their rows:
 * those of acdf_octahedral_bins. Returns 0 on the edges of triangles, and where a corner is not stored or has no
 * light. */
ACDF_INLINE int acdf_local_table_corners(const AcdfLocal* local, const float normal[3],
                                         const AcdfCornerRecord* corner[3], double weight[3]) {
    const double ax = fabs((double)normal[0]), ay = fabs((double)normal[1]), az = fabs((double)normal[2]);
    const double sum = ax + ay + az;
    const int32_t n = (int32_t)local->subdivisions, side = 2 * n + 1;
    double a[3];
    int32_t base[3], over = n, down, x, y, i;
    if (!acdf_are_finite(normal) || !(sum > 0.0)) return 0;
    a[0] = ax / sum * n;
    a[1] = ay / sum * n;
    a[2] = az / sum * n;
    for (i = 0; i < 3; ++i) {
        base[i] = (int32_t)a[i];
        over -= base[i];
    }
    if ((uint32_t)(over - 1) > 1) return 0;
    down = over - 1;
    x = 1 - 2 * (int32_t)(normal[0] < 0.0f);
    y = side - 2 * side * (int32_t)(normal[1] < 0.0f);
    corner[2] = acdf_local_corners(local->tables) + (side * side * (int32_t)(normal[2] < 0.0f) + n * side + n) +
                (x * (base[0] + down) + y * (base[1] + down));
    corner[0] = corner[2] + x * (1 - 2 * down);
    corner[1] = corner[2] + y * (1 - 2 * down);
    for (i = 0; i < 3; ++i)
        weight[i] = fabs((double)down - (a[i] - base[i])) * corner[i]->length * (double)corner[i]->share;
    return weight[0] > 0.0 && weight[1] > 0.0 && weight[2] > 0.0;
}

/* Finds the rows of a normal within a triangle. Returns 0 where tables do not tell. */
ACDF_INLINE int acdf_local_table_rows(const AcdfLocal* local, const float normal[3], AcdfLocalPoint* out) {
    const AcdfCornerRecord* corner[3];
    double weight[3];
    int i;
    if (!acdf_local_table_corners(local, normal, corner, weight)) return 0;
    for (i = 0; i < 3; ++i) {
        acdf_local_tabled_row(local, corner[i]->row, out);
        acdf_mixture_add(&out->mix, &local->blend, corner[i]->row, weight[i]);
    }
    return 1;
}

/* No place. */
ACDF_INLINE void acdf_local_nowhere(AcdfPlaceMixture* place) {
    int i;
    place->count = 0;
    place->alike = 1;
    for (i = 0; i < ACDF_MAX_PLACES_MIXED; ++i) {
        place->row[i] = 0;
        place->columns[i] = 0;
        place->weight[i] = 0.0;
    }
}

/* Begins a point: nothing serves it. */
ACDF_INLINE void acdf_local_nothing(const float normal[3], AcdfLocalPoint* out) {
    int i;
    out->what = ACDF_LOCAL_NOTHING;
    out->root = 0;
    acdf_as_given(normal, out->surface);
    out->normal[0] = out->normal[1] = out->normal[2] = out->length = out->lights = out->sum = 0.0;
    out->mix.count = 0;
    for (i = 0; i < ACDF_MAX_ROWS_MIXED; ++i) {
        out->mix.row[i] = 0;
        out->mix.weight[i] = 0.0;
        out->codes[i] = 0;
        out->parts[i] = 0;
    }
}

/* The environment's tree serves a normal: one of its bins is not stored. */
ACDF_INLINE int acdf_local_whole(const AcdfLocal* local, AcdfLocalPoint* out) {
    out->what = ACDF_LOCAL_TREE;
    out->root = local->environment.root;
    return 0;
}

/* Finds what serves a normal, without the weights of lights and the place. Returns 0 where lights and mixture do
 * not. */
ACDF_FN int acdf_local_begin(const AcdfLocal* local, const float normal[3], AcdfLocalPoint* out) {
    AcdfNormalBins bins;
    int i;
    acdf_local_nothing(normal, out);
    if (local->tables && local->tables->corners && acdf_local_table_rows(local, out->surface, out)) {
        acdf_local_normal(local, out->surface, out);
        return 1;
    }
    if (!acdf_local_bins(local, out->surface, &bins)) return 0;
    if (!local->blend.tiles) {
        const AcdfBin* bin = &local->bins[acdf_nearest_bin(&bins)];
        out->root = bin->root != ACDF_NO_ROOT ? bin->root : local->environment.root;
        if (bin->root == ACDF_NO_ROOT || bin->share > 0.0f) out->what = ACDF_LOCAL_TREE;
        return 0;
    }
    for (i = 0; i < bins.count; ++i) {
        const AcdfBin* bin = &local->bins[bins.bin[i]];
        if (bin->root == ACDF_NO_ROOT) return acdf_local_whole(local, out);
        if (local->tables) acdf_local_tabled_row(local, bin->root, out);
        acdf_mixture_add(&out->mix, &local->blend, bin->root, bins.weight[i] * (double)bin->share);
    }
    acdf_local_normal(local, out->surface, out);
    return 1;
}

/* A row of the fast shape, and what of the mixture it weighs. */
ACDF_INLINE void acdf_local_fast_row(const AcdfLocal* local, uint32_t row, double weight, AcdfLocalPoint* out) {
    if (!(weight > 0.0)) return;
    out->mix.weight[out->mix.count] = weight;
    acdf_fast_set_row(&local->fast, &out->fast, out->mix.count, row);
    acdf_fast_ahead(&local->fast, out->fast.group[out->mix.count]);
    ++out->mix.count;
}

/* acdf_local_begin of files of the fast shape. */
ACDF_FN int acdf_local_begin_fast(const AcdfLocal* local, const float normal[3], AcdfLocalPoint* out) {
    const AcdfCornerRecord* corner[3];
    AcdfNormalBins bins;
    double weight[3];
    int i;
    acdf_local_nothing(normal, out);
    for (i = 0; i < ACDF_FAST_ROWS; ++i) acdf_fast_set_row(&local->fast, &out->fast, i, 0);
    if (local->tables && local->tables->corners && acdf_local_table_corners(local, out->surface, corner, weight)) {
        for (i = 0; i < 3; ++i) acdf_local_fast_row(local, corner[i]->row, weight[i], out);
    } else {
        if (!acdf_local_bins(local, out->surface, &bins)) return 0;
        for (i = 0; i < bins.count; ++i) {
            const AcdfBin* bin = &local->bins[bins.bin[i]];
            if (bin->root == ACDF_NO_ROOT) return acdf_local_whole(local, out);
            acdf_local_fast_row(local, bin->root, bins.weight[i] * (double)bin->share, out);
        }
    }
    acdf_local_normal(local, out->surface, out);
    acdf_fast_mix(out->mix.weight, out->mix.count, &out->fast);
    return 1;
}

/* Weighs lights and mixture together; `visible`: what of each light arrives, null: all. */
ACDF_INLINE void acdf_local_sum(const AcdfLocal* local, const double* visible, AcdfLocalPoint* out) {
    double weight[2];
    uint32_t k;
    if (local->tables && !visible) {
        const AcdfLightPair* pair = acdf_local_lights(local->tables);
        for (k = 0; k < local->light_count; k += 2, ++pair) {
            acdf_light_pair_weights(pair, out, weight);
            out->lights += weight[0];
            out->lights += weight[1];
        }
    } else
        for (k = 0; k < local->light_count; ++k) {
            weight[0] = acdf_light_weight(&local->lights[k], out);
            out->lights += visible ? weight[0] * visible[k] : weight[0];
        }
    out->sum = out->lights + acdf_mixture_sum(&out->mix);
    if (out->sum > 0.0) out->what = local->fast.grid ? ACDF_LOCAL_FAST : ACDF_LOCAL_BLEND;
}

/* Finds what serves a normal. */
ACDF_FN void acdf_local_at(const AcdfLocal* local, const float normal[3], AcdfLocalPoint* out) {
    acdf_local_nowhere(&out->place);
    out->windows.count = 0;
    if (local->fast.grid ? acdf_local_begin_fast(local, normal, out) : acdf_local_begin(local, normal, out))
        acdf_local_sum(local, 0, out);
}

/* Finds what serves a normal at a position of the scene by rows alone, whatever comes through windows. */
ACDF_FN void acdf_local_at_cells(const AcdfLocal* local, const float position[3], const float normal[3],
                                 AcdfLocalPoint* out) {
    double visible, of_light[ACDF_MAX_LIGHTS];
    int i;
    acdf_local_nowhere(&out->place);
    out->windows.count = 0;
    acdf_as_given(normal, out->surface);
    /* First of all: rows of places are far away, and come while the normal's are found. */
    if (local->fast.grid) { /* which knows no places */
        acdf_local_at(local, normal, out);
        return;
    }
    if (local->blend.tiles)
        acdf_place_at(&local->places, local->blend.tiles->tile_count, position, out->surface, &out->place);
    if (!acdf_local_begin(local, normal, out)) {
        out->place.count = 0;
        return;
    }
    if (out->place.count == 0) {
        acdf_local_sum(local, 0, out);
        return;
    }
    visible = acdf_place_visibility(&out->place, 0);
    for (i = 0; i < out->mix.count; ++i) out->mix.weight[i] *= visible;
    acdf_place_see_lights(&out->place, local->light_count, of_light);
    acdf_local_sum(local, of_light, out);
    if (!(out->sum > 0.0)) out->place.count = 0;
}

/* Finds what serves a normal at a position of the scene. Outside of all cells, and where places are not told apart,
 * that is what serves the normal. */
ACDF_FN void acdf_local_at_place(const AcdfLocal* local, const float position[3], const float normal[3],
                                 AcdfLocalPoint* out) {
    acdf_local_at_cells(local, position, normal, out);
    if (local->portals.header && out->place.count > 0)
        acdf_windows_at(&local->portals, &local->places, &out->place, position, out->surface, &out->windows);
}

/* Whether u0 in [0, 1] draws from the mixture, not a light. */
ACDF_FN int acdf_local_draws_mixture(const AcdfLocalPoint* point, double u0) {
    return !(u0 * point->sum < point->lights || point->mix.count == 0);
}

/* The light that u[0] in [0, 1] draws, null where it draws from the mixture. *weight becomes its own. What is left
 * of u[0] takes its place. */
ACDF_FN const AcdfLight* acdf_local_draw_light(const AcdfLocal* local, const AcdfLocalPoint* point, double* u,
                                               double* weight) {
    const AcdfLight* light = 0;
    double x = u[0] * point->sum;
    uint32_t k;
    if (acdf_local_draws_mixture(point, u[0])) {
        u[0] = acdf_unit_interval((x - point->lights) / (point->sum - point->lights));
        return 0;
    }
    *weight = 0.0;
    for (k = 0; k < local->light_count; ++k) {
        const double w = acdf_local_light_weight(local, point, k);
        if (!(w > 0.0)) continue;
        if (light) x -= *weight;
        light = &local->lights[k];
        *weight = w;
        if (x < w) break;
    }
    u[0] = acdf_unit_interval(x / *weight);
    return light;
}
/* The box of a tile that has a light. */
ACDF_INLINE void acdf_light_range(const AcdfLight* light, AcdfRange* range) {
    int axis;
    for (axis = 0; axis < 2; ++axis) {
        range[axis].low = light->low[axis];
        range[axis].high = light->high[axis];
    }
}

/* The light of a tile: its number and 1; 0 where it has none. */
ACDF_FN uint32_t acdf_local_light_of(const AcdfLocal* local, uint32_t tile) {
    uint32_t low = 0, high = local->light_count;
    if (local->tables) return acdf_local_tile(local->tables, tile)->light;
    while (low < high) {
        const uint32_t middle = (low + high) / 2;
        if (local->lights[middle].tile < tile) low = middle + 1;
        else high = middle;
    }
    return low < local->light_count && local->lights[low].tile == tile ? low + 1 : 0;
}

/* The probability of a tile to which the mixture gives that part of itself; 0 where no sample can fall. */
ACDF_FN double acdf_local_tile_probability(const AcdfLocal* local, const AcdfLocalPoint* point, uint32_t tile,
                                           double of_mixture) {
    uint32_t light;
    double probability;
    if (of_mixture > 0.0) return acdf_positive(acdf_mixture_sum(&point->mix) / point->sum * of_mixture);
    light = acdf_local_light_of(local, tile); /* no row gives a light any probability */
    if (light == 0) return 0.0;
    probability = acdf_local_light_weight(local, point, light - 1) / point->sum;
    return probability > 0.0 ? acdf_positive(probability) : 0.0;
}

#ifdef __cplusplus
}
#endif
#endif
