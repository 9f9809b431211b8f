/* Local environment maps as positions of a scene see them: visibility cells and portals over what serves a normal.
 * One freestanding header over acdf/local.h, valid C99, C++17 and CUDA/HIP/SYCL, with the same contract.
 * acdf/visibility/visibility_c.h makes the view of an open file. */
#ifndef ACDF_VISIBLE_LOCAL_H
#define ACDF_VISIBLE_LOCAL_H

#include <acdf/local.h>
#include <acdf/visibility/portals.h>

#ifdef __cplusplus
extern "C" {
#endif

/* A local environment map, with the cells and portals of its file. */
typedef struct AcdfVisibleLocal {
    AcdfLocal local;
    AcdfVisibilityTable cells; /* its header is null where there are none */
    AcdfPortalTable portals;   /* its header is null where there are none */
} AcdfVisibleLocal;

/* A shading point: what serves its normal, and what its position sees. It points into the memory of the file. */
typedef struct AcdfVisiblePoint {
    AcdfLocalPoint local;    /* in a cell `sum` is of what reaches the position */
    uint32_t cell;           /* the number of its row; 0 outside of all cells */
    uint8_t in_cell;         /* whether rows of halvings serve it in a cell; 0: the normal alone counts */
    uint8_t portals;         /* that the position sees */
    AcdfVisiblePortals seen; /* where it sees any */
} AcdfVisiblePoint;
ACDF_STATIC_ASSERT(sizeof(AcdfVisiblePoint) <= 216); /* renderers keep many */

/* The view of a local environment map alone, without cells. */
ACDF_FN AcdfVisibleLocal acdf_visible_everywhere(const AcdfLocal* local) {
    AcdfVisibleLocal out;
    memset(&out, 0, sizeof out);
    out.local = *local;
    return out;
}

/* ---- shading points ---------------------------------------------------------------------------------------- */

/* acdf_visible_at by rows alone, whatever comes through portals. */
ACDF_FN void acdf_visible_at_cells(const AcdfVisibleLocal* view, const float position[3], const float normal[3],
                                   AcdfVisiblePoint* out) {
    AcdfVisibilityCell cell;
    float surface[3];
    int found = 0;
    /* First of all: rows of visibility cells are far away, and come while the normal's are found. */
    acdf_as_given(normal, surface);
    if (position) found = acdf_visibility_at(&view->cells, position, surface, &cell);
    acdf_local_at(&view->local, normal, &out->local);
    out->cell = 0;
    out->in_cell = out->portals = 0;
    if (!found || out->local.what != ACDF_LOCAL_ROWS) return;
    out->local.sum *= acdf_visibility_of_code(cell.row[0]);
    out->in_cell = 1;
    out->cell = cell.number;
}

/* Finds what serves a normal of any length but 0 at a position, in the coordinates of the scene that the file was
 * made for; null: anywhere. Outside of all cells, and where there are none, that is what serves the normal. */
ACDF_FN void acdf_visible_at(const AcdfVisibleLocal* view, const float position[3], const float normal[3],
                             AcdfVisiblePoint* out) {
    acdf_visible_at_cells(view, position, normal, out);
    if (view->portals.header && out->in_cell)
        out->portals = (uint8_t)acdf_visible_portals_at(&view->portals, &view->cells, out->cell, position,
                                                        out->local.surface, &out->seen);
}

/* The rows of a point in a cell, which is found again, as it sees them. */
ACDF_INLINE AcdfVisibleRows acdf_visible_rows(const AcdfVisibleLocal* view, const AcdfVisiblePoint* point,
                                              AcdfVisibilityCell* cell) {
    AcdfVisibleRows out;
    *cell = acdf_visibility_cell(&view->cells, point->cell);
    out.rows = view->local.rows_of_normals;
    out.mix = &point->local.by.rows;
    out.table = &view->cells;
    out.cell = cell;
    return out;
}

/* Looks from a point that sees portals. */
ACDF_INLINE void acdf_visible_eye(const AcdfVisibleLocal* view, const AcdfVisiblePoint* point, AcdfPortalEye* out) {
    acdf_portal_eye(&view->portals, &view->cells, point->cell, point->seen.position, point->local.surface, out);
}

/* ---- pdfs -------------------------------------------------------------------------------------------------- */

/* acdf_local_find_cell at a point: without what comes through portals. */
ACDF_FN double acdf_visible_find_cell(const AcdfVisibleLocal* view, const AcdfVisiblePoint* point,
                                      const uint32_t square[2], AcdfRange range[2]) {
    const AcdfLocal* local = &view->local;
    const AcdfGrid grid = acdf_environment_grid(&local->environment);
    AcdfVisibilityCell of_point;
    AcdfVisibleRows in;
    AcdfRowCell cell;
    uint32_t tile;
    if (!point->in_cell) return acdf_local_find_cell(local, &point->local, square, range);
    tile = acdf_rows_find_tile(local->rows_of_normals, square);
    cell =
        acdf_rows_find_cell(local->environment.halved, &grid, acdf_row_tile(local->rows_of_normals, tile), square);
    acdf_halved_ranges(cell.box, range);
    in = acdf_visible_rows(view, point, &of_point);
    return acdf_visible_share(&in, tile) * cell.share;
}

/* The pdf of what rows sample at a point in a cell. */
ACDF_FN float acdf_visible_rows_pdf(const AcdfVisibleLocal* view, const AcdfVisiblePoint* point,
                                    const float direction[3]) {
    const AcdfLocal* local = &view->local;
    const AcdfGrid grid = acdf_environment_grid(&local->environment);
    AcdfRowSpot spot = acdf_rows_spot(local->rows_of_normals, &grid, direction);
    AcdfVisibilityCell of_point;
    AcdfVisibleRows in;
    AcdfRowCell cell;
    if (!acdf_rows_locate(local->rows_of_normals, local->environment.halved, &grid, &spot, direction, &cell))
        return 0.0f;
    in = acdf_visible_rows(view, point, &of_point);
    return acdf_float_pdf(acdf_visible_share(&in, spot.tile) * cell.share * cell.scale);
}

/* Of rows and portals together; `rows`: that of rows. */
ACDF_OUTLINE_ON_CPU float acdf_visible_through_pdf(const AcdfVisibleLocal* view, const AcdfVisiblePoint* point,
                                                   const float direction[3], float rows) {
    AcdfPortalEye eye;
    acdf_visible_eye(view, point, &eye);
    return acdf_visible_portals_pdf(&eye, &point->seen, direction, rows);
}

/* The part of the pdf that follows the light, of a point in a cell. */
ACDF_FN float acdf_visible_light_pdf(const AcdfVisibleLocal* view, const AcdfVisiblePoint* point,
                                     const float direction[3]) {
    const float rows = acdf_visible_rows_pdf(view, point, direction);
    return point->portals > 0 ? acdf_visible_through_pdf(view, point, direction, rows) : rows;
}

/* Pdf per steradian with which acdf_visible_sample samples `direction` (unit). */
ACDF_OUTLINE_ON_CPU float acdf_visible_pdf(const AcdfVisibleLocal* view, const AcdfVisiblePoint* point,
                                           const float direction[3]) {
    if (!point->in_cell) return acdf_local_pdf_at(&view->local, &point->local, direction);
    return acdf_local_combined_pdf(&view->local, &point->local, direction,
                                   acdf_visible_light_pdf(view, point, direction));
}

/* ---- samples ----------------------------------------------------------------------------------------------- */

/* Samples by rows at a point in a cell; u in [0, 1]. */
ACDF_INLINE AcdfDirectionSample acdf_visible_rows_sample(const AcdfVisibleLocal* view,
                                                         const AcdfVisiblePoint* point, double u[2]) {
    const AcdfGrid grid = acdf_environment_grid(&view->local.environment);
    AcdfVisibilityCell cell;
    const AcdfVisibleRows in = acdf_visible_rows(view, point, &cell);
    double share;
    const AcdfTopTile* tile = acdf_visible_sample_tile(&in, u, &share);
    return acdf_rows_direction(view->local.environment.halved, &grid, tile, share, u);
}

/* Samples through the portals of a position. The pdf is that of the direction as it was rounded. */
ACDF_OUTLINE_ON_CPU AcdfDirectionSample acdf_visible_through_sample(const AcdfVisibleLocal* view,
                                                                    const AcdfVisiblePoint* point, double u[2]) {
    AcdfPortalEye eye;
    AcdfDirectionSample out;
    acdf_visible_eye(view, point, &eye);
    acdf_visible_portals_sample(&eye, &point->seen, u, out.direction);
    out.pdf = acdf_visible_portals_pdf(&eye, &point->seen, out.direction,
                                       acdf_visible_rows_pdf(view, point, out.direction));
    return out;
}

/* Samples a direction; u0 (phi) and u1 (theta) in [0, 1]. Values outside are clamped, NaN counts as 0. The pdf is
 * in sr^-1; it is 0, and the direction is unset, where the normal is not valid or no light reaches it. */
ACDF_OUTLINE_ON_CPU AcdfDirectionSample acdf_visible_sample(const AcdfVisibleLocal* view,
                                                            const AcdfVisiblePoint* point, double u0, double u1) {
    AcdfDirectionSample out = {{0.0f, 0.0f, 0.0f}, 0.0f};
    double u[2];
    if (!point->in_cell) return acdf_local_sample_at(&view->local, &point->local, u0, u1);
    if (acdf_local_choose_cosine(&view->local, u0, u1, u)) {
        acdf_cosine_direction(point->local.surface, u[0], u[1], out.direction);
        out.pdf = acdf_visible_light_pdf(view, point, out.direction);
    } else if (point->portals > 0 && acdf_visible_portals_choose(&point->seen, u)) {
        out = acdf_visible_through_sample(view, point, u);
    } else {
        out = acdf_visible_rows_sample(view, point, u);
        if (point->portals > 0) out.pdf = acdf_visible_light_pdf(view, point, out.direction);
    }
    out.pdf = acdf_local_combined_pdf(&view->local, &point->local, out.direction, out.pdf);
    return acdf_returned(&out);
}

#ifdef __cplusplus
}
#endif
#endif
