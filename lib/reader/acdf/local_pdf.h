/* Pdfs of local environment maps. Part of acdf/local.h. */
#ifndef ACDF_LOCAL_PDF_H
#define ACDF_LOCAL_PDF_H

#include <acdf/local_point.h>

#ifdef __cplusplus
extern "C" {
#endif

/* What of all samples at a point of rows of halvings a tile has. */
ACDF_INLINE double acdf_local_row_share(const AcdfLocal* local, const AcdfLocalPoint* point, uint32_t tile) {
    AcdfVisibilityCell cell;
    AcdfVisibleRows in;
    if (!point->in_cell) return acdf_rows_mass(&point->by.rows, tile, tile + 1u) * 0x1p-52;
    in = acdf_local_visible_rows(local, point, &cell);
    return acdf_visible_share(&in, tile);
}

/* The pdf of what rows of halvings sample. */
ACDF_INLINE float acdf_local_rows_pdf(const AcdfLocal* local, const AcdfLocalPoint* point, const AcdfGrid* grid,
                                      const AcdfRowSpot* given, const float direction[3]) {
    AcdfRowSpot spot = *given;
    AcdfRowCell cell;
    if (!acdf_rows_locate(local->rows_of_normals, local->environment.halved, grid, &spot, direction, &cell))
        return 0.0f;
    return acdf_float_pdf(acdf_local_row_share(local, point, spot.tile) * cell.share * cell.scale);
}

/* The tree that serves a point. */
ACDF_INLINE AcdfEnvironment acdf_local_tree(const AcdfLocal* local, const AcdfLocalPoint* point) {
    AcdfEnvironment tree = local->environment;
    tree.root = point->by.root;
    return tree;
}

/* The cell of a grid square that rows, or a tree, sample at a point, which becomes `range`, and its probability: 0
 * where no sample can fall. */
ACDF_FN double acdf_local_find_cell(const AcdfLocal* local, const AcdfLocalPoint* point, const uint32_t square[2],
                                    AcdfRange range[2]) {
    const AcdfEnvironment* env = &local->environment;
    acdf_sphere_ranges(env->columns, env->rows, range);
    if (point->what == ACDF_LOCAL_NOTHING) return 0.0;
    if (point->what == ACDF_LOCAL_ROWS) {
        const AcdfGrid grid = acdf_environment_grid(env);
        const uint32_t tile = acdf_rows_find_tile(local->rows_of_normals, square);
        const AcdfRowCell cell =
            acdf_rows_find_cell(env->halved, &grid, acdf_row_tile(local->rows_of_normals, tile), square);
        acdf_halved_ranges(cell.box, range);
        return acdf_local_row_share(local, point, tile) * cell.share;
    }
    {
        const AcdfEnvironment tree = acdf_local_tree(local, point);
        AcdfStratum strata[2];
        return acdf_environment_find_square(&tree, square, range, strata);
    }
}

/* The pdf of what rows, or a tree, sample, in a direction. */
ACDF_FN float acdf_local_row_pdf(const AcdfLocal* local, const AcdfLocalPoint* point, const float direction[3]) {
    AcdfEnvironment tree;
    if (point->what == ACDF_LOCAL_NOTHING) return 0.0f;
    if (point->what == ACDF_LOCAL_ROWS) {
        const AcdfGrid grid = acdf_environment_grid(&local->environment);
        const AcdfRowSpot at = acdf_rows_spot(local->rows_of_normals, &grid, direction);
        return acdf_local_rows_pdf(local, point, &grid, &at, direction);
    }
    tree = acdf_local_tree(local, point);
    return acdf_environment_pdf(&tree, direction);
}

/* Looks from a point that sees portals. */
ACDF_INLINE void acdf_local_eye(const AcdfLocal* local, const AcdfLocalPoint* point, AcdfPortalEye* out) {
    acdf_portal_eye(&local->portals, &local->visibility, point->place.cell, point->place.portals.position,
                    point->surface, out);
}

/* Of rows and portals together; `row`: that of rows. */
ACDF_OUTLINE_ON_CPU float acdf_local_portals_pdf(const AcdfLocal* local, const AcdfLocalPoint* point,
                                                 const float direction[3], float row) {
    AcdfPortalEye eye;
    acdf_local_eye(local, point, &eye);
    return acdf_visible_portals_pdf(&eye, &point->place.portals, direction, row);
}

/* The part of the pdf that follows the light: that of rows, and of portals where a position sees any. */
ACDF_FN float acdf_local_light_pdf(const AcdfLocal* local, const AcdfLocalPoint* point, const float direction[3]) {
    const float row = acdf_local_row_pdf(local, point, direction);
    return point->portals > 0 ? acdf_local_portals_pdf(local, point, direction, row) : row;
}

/* The pdf of the mixture of light and cosine: `light` is the pdf of the light's part. */
ACDF_FN float acdf_local_combined_pdf(const AcdfLocal* local, const AcdfLocalPoint* point, const float direction[3],
                                      float light) {
    const double x = point->surface[0], y = point->surface[1], z = point->surface[2];
    const double share = local->cosine_share;
    double dx, dy, dz, size, cosine, pdf;
    float given[3];
    if (share == 0.0) return light;
    acdf_as_given(direction, given);
    dx = given[0];
    dy = given[1];
    dz = given[2];
    size = sqrt(dx * dx + dy * dy + dz * dz);
    if (!(size > 0.9995 && size < 1.0005)) return 0.0f;
    cosine = (x * dx + y * dy + z * dz) / sqrt(x * x + y * y + z * z);
    pdf = (1.0 - share) * (double)light + (cosine > 0.0 ? share * cosine * (1.0 / ACDF_PI) : 0.0);
    return pdf > 1.17549435e-38 || pdf == 0.0 ? (float)pdf : 1.17549435e-38f;
}

/* Pdf per steradian with which acdf_local_sample_at samples `direction` (unit). */
ACDF_OUTLINE_ON_CPU float acdf_local_pdf_at(const AcdfLocal* local, const AcdfLocalPoint* point,
                                            const float direction[3]) {
    if (point->what == ACDF_LOCAL_NOTHING) return 0.0f;
    return acdf_local_combined_pdf(local, point, direction, acdf_local_light_pdf(local, point, direction));
}
/* The pdf for a normal of a single call by trees of curves. */
ACDF_OUTLINE_ON_CPU float acdf_local_new_tree_pdf(const AcdfLocal* local, const float normal[3],
                                                  const float direction[3]) {
    AcdfLocalPoint point;
    acdf_local_at(local, normal, &point);
    return acdf_local_pdf_at(local, &point, direction);
}
/* The pdf for a normal of a single call by rows of halvings. */
ACDF_OUTLINE_ON_CPU float acdf_local_new_rows_pdf(const AcdfLocal* local, const float normal[3],
                                                  const float direction[3]) {
    const AcdfGrid grid = acdf_environment_grid(&local->environment);
    const AcdfRowSpot spot = acdf_rows_spot(local->rows_of_normals, &grid, direction);
    AcdfLocalPoint point;
    acdf_local_rows_at(local, normal, &point);
    if (point.what != ACDF_LOCAL_ROWS) return acdf_local_pdf_at(local, &point, direction);
    return acdf_local_combined_pdf(local, &point, direction,
                                   acdf_local_rows_pdf(local, &point, &grid, &spot, direction));
}
/* Pdf per steradian with which acdf_local_sample samples `direction` (unit) for that normal. */
ACDF_FN float acdf_local_pdf(const AcdfLocal* local, const float normal[3], const float direction[3]) {
    if (local->rows_of_normals) return acdf_local_new_rows_pdf(local, normal, direction);
    return acdf_local_new_tree_pdf(local, normal, direction);
}

#ifdef __cplusplus
}
#endif
#endif
