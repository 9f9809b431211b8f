/* Shading points of a local environment map: what serves a normal (SPEC.md §10.3). Part of acdf/local.h. */
#ifndef ACDF_LOCAL_POINT_H
#define ACDF_LOCAL_POINT_H

#include <acdf/bright_tiles.h>
#include <acdf/local_corners.h>

#ifdef __cplusplus
extern "C" {
#endif

/* The bin of the largest weight. */
ACDF_FN uint32_t acdf_nearest_bin(const AcdfNormalBins* bins) {
    int i, nearest = 0;
    for (i = 1; i < bins->count; ++i)
        if (bins->weight[i] > bins->weight[nearest]) nearest = i;
    return bins->bin[nearest];
}

/* Where the row of the next one that is added to the mixture goes. */
ACDF_INLINE void acdf_local_tabled_row(const AcdfLocal* local, uint32_t row, AcdfLocalPoint* out) {
    const AcdfLocalTables* tables = local->tables;
    AcdfTabledRows* of = &out->by.tabled;
    of->codes[out->mix.count] = acdf_tile_row(acdf_local_words(tables), &tables->tiles, row);
    ACDF_PREFETCH(of->codes[out->mix.count]);
    if (tables->parts) of->parts[out->mix.count] = acdf_local_parts(tables, row, local->blend.tiles->tile_count);
}

/* Finds the rows of a normal within a triangle. Returns 0 where tables have no answer. */
ACDF_INLINE int acdf_local_table_rows(const AcdfLocal* local, const float normal[3], AcdfLocalPoint* out) {
    double weight[3], scale;
    const AcdfFacet* facet = acdf_local_find_facet(local, normal, weight, &scale);
    int i;
    if (!facet) return 0;
    for (i = 0; i < 3; ++i) {
        acdf_local_tabled_row(local, facet->row[i], out);
        acdf_mixture_add(&out->mix, &local->blend, facet->row[i], weight[i]);
    }
    out->by.tabled.facet = facet;
    acdf_local_scaled(scale, acdf_local_length(normal), out);
    return 1;
}

/* Begins a point: nothing serves it. */
ACDF_INLINE void acdf_local_nothing(const float normal[3], AcdfLocalPoint* out) {
    int i;
    acdf_local_no_rows(normal, out);
    out->by.tabled.facet = 0;
    for (i = 0; i < ACDF_MAX_ROWS_MIXED; ++i) {
        out->mix.row[i] = 0;
        out->mix.weight[i] = 0.0;
    }
    for (i = 0; i < ACDF_NORMALS_MIXED; ++i) {
        out->by.tabled.codes[i] = 0;
        out->by.tabled.parts[i] = 0;
    }
}

/* Finds what serves a normal, without the weights of bright tiles and the mixture. Returns 0 where bright tiles and
 * mixture do not. */
ACDF_FN int acdf_local_begin(const AcdfLocal* local, const float normal[3], AcdfLocalPoint* out) {
    AcdfNormalBins bins;
    int i;
    acdf_local_nothing(normal, out);
    if (local->tables && local->tables->facets && acdf_local_table_rows(local, out->surface, out)) return 1;
    if (!acdf_local_bins(local, out->surface, &bins)) return 0;
    if (!local->blend.tiles) {
        const AcdfBin* bin = &local->bins[acdf_nearest_bin(&bins)];
        out->by.root = bin->root != ACDF_NO_ROOT ? bin->root : local->environment.root;
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

/* Weights bright tiles and mixture together. */
ACDF_INLINE void acdf_local_sum(const AcdfLocal* local, AcdfLocalPoint* out) {
    const AcdfFacet* facet = out->by.tabled.facet;
    const AcdfScaledNormal normal = acdf_local_scaled_normal(out);
    uint32_t k;
    if (facet) out->bright_tiles = acdf_facet_bright_tiles(local, facet, &normal);
    else
        for (k = 0; k < local->bright_tile_count; ++k)
            out->bright_tiles += acdf_bright_tile_weight(&local->bright_tiles[k], &normal);
    out->sum = out->bright_tiles + acdf_mixture_sum(&out->mix);
    if (out->sum > 0.0) out->what = ACDF_LOCAL_BLEND;
}

/* acdf_local_at of one tree of halvings. */
ACDF_INLINE void acdf_local_rows_at(const AcdfLocal* local, const float normal[3], AcdfLocalPoint* out) {
    AcdfNormalBins bins;
    double weight[3];
    uint32_t row[3];
    int i, count = 0;
    acdf_local_no_rows(normal, out);
    if (!acdf_local_bins(local, out->surface, &bins)) return;
    for (i = 0; i < bins.count; ++i) {
        const AcdfBin* bin = &local->bins[bins.bin[i]];
        if (bin->root == ACDF_NO_ROOT) {
            acdf_local_whole(local, out);
            return;
        }
        if (!(bin->share > 0.0f)) continue;
        row[count] = bin->root;
        out->sum += weight[count++] = bins.weight[i] * (double)bin->share;
    }
    acdf_local_normal(local, out->surface, out);
    if (!(out->sum > 0.0)) return;
    acdf_rows_mix(local->rows_of_normals, row, weight, count, &out->by.rows);
    out->what = ACDF_LOCAL_ROWS;
}

/* Finds what serves a normal. */
ACDF_FN void acdf_local_at(const AcdfLocal* local, const float normal[3], AcdfLocalPoint* out) {
    if (local->rows_of_normals) {
        acdf_local_rows_at(local, normal, out);
        return;
    }
    if (acdf_local_begin(local, normal, out)) acdf_local_sum(local, out);
}

/* Finds what serves a normal at a position of the scene by rows alone, and the visibility cells of that. */
ACDF_FN void acdf_local_in_cells(const AcdfLocal* local, const float position[3], const float normal[3],
                                 AcdfVisibilityMixture* cells, AcdfLocalPoint* out) {
    float surface[3];
    /* First of all: rows of visibility cells are far away, and come while the normal's are found. */
    acdf_as_given(normal, surface);
    acdf_visibility_at(&local->visibility, position, surface, cells);
    acdf_local_at(local, normal, out);
    if (cells->count == 0 || out->what != ACDF_LOCAL_ROWS) return;
    out->sum *= acdf_mixture_visibility(cells);
    out->cells = (uint8_t)cells->count;
    memcpy(out->place.row, cells->number, sizeof cells->number);
    memcpy(out->place.weight, cells->weight, sizeof cells->weight);
}

/* The visibility cells of a point, but for their rows; and with them. */
ACDF_INLINE void acdf_local_numbers_of_cells(const AcdfLocalPoint* point, AcdfVisibilityMixture* out) {
    out->count = point->cells;
    memcpy(out->number, point->place.row, sizeof out->number);
    memcpy(out->weight, point->place.weight, sizeof out->weight);
}
ACDF_INLINE void acdf_local_cells(const AcdfLocal* local, const AcdfLocalPoint* point, AcdfVisibilityMixture* out) {
    acdf_local_numbers_of_cells(point, out);
    acdf_visibility_open(&local->visibility, out);
}

/* The rows of a point as its position sees them; `cells` become its own. */
ACDF_INLINE AcdfVisibleRows acdf_local_visible_rows(const AcdfLocal* local, const AcdfLocalPoint* point,
                                                    AcdfVisibilityMixture* cells) {
    AcdfVisibleRows out;
    acdf_local_cells(local, point, cells);
    out.rows = local->rows_of_normals;
    out.mix = &point->by.rows;
    out.table = &local->visibility;
    out.cells = cells;
    return out;
}

/* Finds what serves a normal at a position of the scene by rows alone, whatever comes through portals. */
ACDF_FN void acdf_local_at_cells(const AcdfLocal* local, const float position[3], const float normal[3],
                                 AcdfLocalPoint* out) {
    AcdfVisibilityMixture cells;
    acdf_local_in_cells(local, position, normal, &cells, out);
}

/* Finds what serves a normal at a position of the scene. Outside of all cells, and where there are no visibility
 * cells, that is what serves the normal. */
ACDF_FN void acdf_local_at_position(const AcdfLocal* local, const float position[3], const float normal[3],
                                    AcdfLocalPoint* out) {
    AcdfVisibilityMixture cells;
    acdf_local_in_cells(local, position, normal, &cells, out);
    if (local->portals.header && out->cells > 0)
        out->portals = (uint8_t)acdf_visible_portals_at(&local->portals, &local->visibility, &cells, position,
                                                        out->surface, &out->place.portals);
}

/* Whether u0 in [0, 1] samples from the mixture, not a bright tile. */
ACDF_FN int acdf_local_samples_mixture(const AcdfLocalPoint* point, double u0) {
    return !(u0 * point->sum < point->bright_tiles || point->mix.count == 0);
}

/* The light that u[0] in [0, 1] samples, null where it samples from the mixture. *weight becomes its own. What is
 * left of u[0] takes its mixture. */
ACDF_FN const AcdfBrightTile* acdf_local_sample_bright_tile(const AcdfLocal* local, const AcdfLocalPoint* point,
                                                            double* u, double* weight) {
    const AcdfBrightTile* light = 0;
    double x = u[0] * point->sum;
    uint32_t k;
    if (acdf_local_samples_mixture(point, u[0])) {
        u[0] = acdf_unit_interval((x - point->bright_tiles) / (point->sum - point->bright_tiles));
        return 0;
    }
    *weight = 0.0;
    for (k = 0; k < local->bright_tile_count; ++k) {
        const double w = acdf_local_bright_tile_weight(local, point, k);
        if (!(w > 0.0)) continue;
        if (light) x -= *weight;
        light = &local->bright_tiles[k];
        *weight = w;
        if (x < w) break;
    }
    u[0] = acdf_unit_interval(x / *weight);
    return light;
}
/* The box of a bright tile. */
ACDF_INLINE void acdf_light_range(const AcdfBrightTile* light, AcdfRange* range) {
    int axis;
    for (axis = 0; axis < 2; ++axis) {
        range[axis].low = light->low[axis];
        range[axis].high = light->high[axis];
    }
}

/* The light of a tile: its number and 1; 0 where it has none. */
ACDF_FN uint32_t acdf_local_bright_tile_of(const AcdfLocal* local, uint32_t tile) {
    uint32_t low = 0, high = local->bright_tile_count;
    if (local->tables) return acdf_local_tile(local->tables, tile)->light;
    while (low < high) {
        const uint32_t middle = (low + high) / 2;
        if (local->bright_tiles[middle].tile < tile) low = middle + 1;
        else high = middle;
    }
    return low < local->bright_tile_count && local->bright_tiles[low].tile == tile ? low + 1 : 0;
}

/* The probability of a tile to which the mixture gives that part of itself; 0 where no sample can fall. */
ACDF_FN double acdf_local_tile_probability(const AcdfLocal* local, const AcdfLocalPoint* point, uint32_t tile,
                                           double of_mixture) {
    uint32_t light;
    double probability;
    if (of_mixture > 0.0) return acdf_positive(acdf_mixture_sum(&point->mix) / point->sum * of_mixture);
    light = acdf_local_bright_tile_of(local, tile); /* no row gives a bright tile any probability */
    if (light == 0) return 0.0;
    probability = acdf_local_bright_tile_weight(local, point, light - 1) / point->sum;
    return probability > 0.0 ? acdf_positive(probability) : 0.0;
}

#ifdef __cplusplus
}
#endif
#endif
