/* Shading points of a local environment map: what serves a normal (SPEC.md §10.3). Part of acdf/local.h. */
#ifndef ACDF_LOCAL_POINT_H
#define ACDF_LOCAL_POINT_H

#include <acdf/local_parts.h>

#ifdef __cplusplus
extern "C" {
#endif

/* Begins a point: nothing serves it. */
ACDF_INLINE void acdf_local_nothing(const float normal[3], AcdfLocalPoint* out) {
    out->what = ACDF_LOCAL_NOTHING;
    out->in_cell = out->portals = 0;
    acdf_as_given(normal, out->surface);
    out->length = out->sum = 0.0;
}

/* A tree serves a normal. */
ACDF_INLINE void acdf_local_by_tree(uint32_t root, AcdfLocalPoint* out) {
    out->what = ACDF_LOCAL_TREE;
    out->by.root = root;
}

/* The length of a normal in the scale of the weights of the corners of an octahedron. */
ACDF_INLINE double acdf_local_length(const AcdfLocal* local, const float normal[3]) {
    const double x = normal[0], y = normal[1], z = normal[2];
    return (double)local->subdivisions / (fabs(x) + fabs(y) + fabs(z)) * sqrt(x * x + y * y + z * z);
}

/* Finds what serves a normal: bins are corners of an octahedron. */
ACDF_INLINE void acdf_local_rows_at(const AcdfLocal* local, const float normal[3], AcdfLocalPoint* out) {
    AcdfNormalBins bins;
    double weight[ACDF_NORMALS_MIXED];
    uint32_t row[ACDF_NORMALS_MIXED];
    int i, count = 0;
    acdf_local_nothing(normal, out);
    if (!acdf_octahedral_bins(local->subdivisions, out->surface, &bins)) return;
    for (i = 0; i < bins.count; ++i) {
        const AcdfBin* bin = &local->bins[bins.bin[i]];
        if (bin->root == ACDF_NO_ROOT) {
            acdf_local_by_tree(local->environment.root, out);
            return;
        }
        if (!(bin->share > 0.0f)) continue;
        row[count] = bin->root;
        out->sum += weight[count++] = bins.weight[i] * (double)bin->share;
    }
    out->length = acdf_local_length(local, out->surface);
    if (!(out->sum > 0.0)) return;
    acdf_rows_mix(local->rows_of_normals, row, weight, count, &out->by.rows);
    out->what = ACDF_LOCAL_ROWS;
}

/* Finds what serves a normal. */
ACDF_FN void acdf_local_at(const AcdfLocal* local, const float normal[3], AcdfLocalPoint* out) {
    ACDF_RETURN_CURVES(&local->environment, local_at(local, normal, out));
    acdf_local_rows_at(local, normal, out);
}

/* Finds what serves a normal at a position of the scene by rows alone, whatever comes through portals. */
ACDF_FN void acdf_local_at_cells(const AcdfLocal* local, const float position[3], const float normal[3],
                                 AcdfLocalPoint* out) {
    AcdfVisibilityCell cell;
    float surface[3];
    int found;
    /* First of all: rows of visibility cells are far away, and come while the normal's are found. */
    acdf_as_given(normal, surface);
    found = acdf_visibility_at(&local->visibility, position, surface, &cell);
    acdf_local_at(local, normal, out);
    if (!found || out->what != ACDF_LOCAL_ROWS) return;
    out->sum *= acdf_visibility_of_code(cell.row[0]);
    out->in_cell = 1;
    out->place.cell = cell.number;
}

/* The rows of a point as its visibility cell, which is found again, sees them. */
ACDF_INLINE AcdfVisibleRows acdf_local_visible_rows(const AcdfLocal* local, const AcdfLocalPoint* point,
                                                    AcdfVisibilityCell* cell) {
    AcdfVisibleRows out;
    *cell = acdf_visibility_cell(&local->visibility, point->place.cell);
    out.rows = local->rows_of_normals;
    out.mix = &point->by.rows;
    out.table = &local->visibility;
    out.cell = cell;
    return out;
}

/* Finds what serves a normal at a position of the scene. Outside of all cells, and where there are no visibility
 * cells, that is what serves the normal. */
ACDF_FN void acdf_local_at_position(const AcdfLocal* local, const float position[3], const float normal[3],
                                    AcdfLocalPoint* out) {
    acdf_local_at_cells(local, position, normal, out);
    if (local->portals.header && out->in_cell)
        out->portals = (uint8_t)acdf_visible_portals_at(&local->portals, &local->visibility, out->place.cell,
                                                        position, out->surface, &out->place.portals);
}

#ifdef __cplusplus
}
#endif
#endif
