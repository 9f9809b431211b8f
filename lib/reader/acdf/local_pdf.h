/* Pdfs of local environment maps. Part of acdf/local.h. */
#ifndef ACDF_LOCAL_PDF_H
#define ACDF_LOCAL_PDF_H

#include <acdf/local_position.h>
#include <acdf/row_heights.h>

#ifdef __cplusplus
extern "C" {
#endif

/* What of all samples at a point of rows of halvings a tile has. */
ACDF_INLINE double acdf_local_row_share(const AcdfLocal* local, const AcdfLocalPoint* point, uint32_t tile) {
    AcdfVisibilityMixture cells;
    AcdfVisibleRows in;
    if (point->cells == 0) return acdf_rows_mass(&point->by.rows, tile, tile + 1u) * 0x1p-52;
    in = acdf_local_visible_rows(local, point, &cells);
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

/* Whether runtime tables know the tiles. */
ACDF_INLINE int acdf_local_tabled(const AcdfLocal* local) { return local->tables != 0; }

/* Where the curves of a tile begin; ACDF_NO_ROOT: it is a cell. */
ACDF_INLINE uint32_t acdf_local_tile_root(const AcdfLocal* local, uint32_t tile) {
    if (local->tables) return acdf_local_tile(local->tables, tile)->root;
    return local->blend.roots ? local->blend.roots[tile] : ACDF_NO_ROOT;
}

/* Asks for the curves of a tile while something else is done. */
ACDF_INLINE void acdf_local_ahead(const AcdfLocal* local, const AcdfTileRecord* tile) {
    const uint32_t any = tile->root != ACDF_NO_ROOT ? tile->root : 0; /* of cells something that is no use */
    ACDF_PREFETCH(local->blend.tree + 2 * (size_t)any);
}

/* The range of a tile that tables found, and its share of a mixture that `first` splits above it have been taken
 * from. */
ACDF_INLINE double acdf_local_found_tile(const AcdfLocal* local, const AcdfLocalPoint* point,
                                         const AcdfMixture* mix, uint32_t tile, uint32_t first, AcdfRange* range) {
    const AcdfTileRecord* record = acdf_local_tile(local->tables, tile);
    double given;
    acdf_local_ahead(local, record);
    given = acdf_tile_share(acdf_local_words(local->tables), &local->tables->tiles, mix, point->by.tabled.codes,
                            record, first);
    acdf_tile_range(record, range);
    return given > 0.0 ? acdf_positive(given / acdf_mixture_sum(mix)) : 0.0;
}

/* Finds the cell of a square in a tile of a probability; returns that of the cell. */
ACDF_INLINE double acdf_local_find_inside(const AcdfLocal* local, uint32_t tile, double probability,
                                          const uint32_t* square, AcdfRange* range) {
    const uint32_t root = acdf_local_tile_root(local, tile);
    double inside;
    if (!(probability > 0.0) || root == ACDF_NO_ROOT) return probability;
    inside = acdf_tree_locate(local->blend.tree, local->environment.tree_units, root, square, range);
    return inside > 0.0 ? acdf_positive(probability * inside) : 0.0;
}

/* Where a direction lies, which does not depend on the shading point: it is looked for before that is made, where
 * both are new. */
typedef struct AcdfLocalSpot {
    const AcdfTilePiece* piece; /* by tables; null: they have none */
    uint32_t square[2];
    uint32_t tile; /* by tables, where they have no piece */
    int valid;     /* 0: it is no direction */
} AcdfLocalSpot;

/* `tables`: those that serve the shading point; null: none do, or it may be served by none. */
ACDF_INLINE AcdfLocalSpot acdf_local_spot(const AcdfLocal* local, const AcdfLocalTables* tables,
                                          const float direction[3]) {
    const AcdfGrid grid = acdf_environment_grid(&local->environment);
    AcdfLocalSpot out;
    out.piece = tables && tables->pieces ? acdf_local_find_piece(tables, direction) : 0;
    out.square[0] = out.square[1] = out.tile = 0;
    out.valid = out.piece || acdf_local_square(&grid, direction, out.square);
    if (!tables || out.piece || !out.valid) return out;
    out.tile = acdf_tile_at(acdf_local_words(tables), &tables->tiles, out.square);
    ACDF_PREFETCH(acdf_local_tile(tables, out.tile));
    return out;
}

/* The cell of a square in the mixture of bright tiles and rows, which becomes `range`, as acdf_tree_find does.
 * Returns its probability, 0 where no sample can fall. */
ACDF_FN double acdf_local_blend_find(const AcdfLocal* local, const AcdfLocalPoint* point, const AcdfLocalSpot* spot,
                                     AcdfRange* range) {
    double probability;
    uint32_t tile = spot->tile;
    if (acdf_local_tabled(local)) probability = acdf_local_found_tile(local, point, &point->mix, tile, 0, range);
    else tile = acdf_blend_find_tile(&local->blend, &point->mix, spot->square, range, 0, &probability);
    probability = acdf_local_tile_probability(local, point, tile, probability);
    return acdf_local_find_inside(local, tile, probability, spot->square, range);
}

/* The part of the pdf that follows the light, in a piece that tables know. */
ACDF_INLINE float acdf_local_piece_pdf(const AcdfLocal* local, const AcdfLocalPoint* point,
                                       const AcdfTilePiece* piece) {
    const AcdfMixture* mix = &point->mix;
    double part[ACDF_MAX_ROWS_MIXED], probability;
    int i;
    for (i = 0; i < mix->count; ++i) part[i] = point->by.tabled.parts[i][piece->tile];
    probability = acdf_mixture_of(mix, mix->count, part);
    if (probability > 0.0) probability = acdf_positive(probability / acdf_mixture_sum(mix));
    probability = acdf_local_tile_probability(local, point, piece->tile, probability);
    if (!(probability > 0.0 && piece->probability > 0.0)) return 0.0f;
    return acdf_area_pdf(acdf_positive(probability * piece->probability), local->environment.columns, piece->area,
                         1.0);
}

/* The pdf of a direction in a cell of probability p. */
ACDF_INLINE float acdf_local_cell_pdf(const AcdfLocal* local, const AcdfGrid* grid, const float direction[3],
                                      const AcdfRange range[2], double p) {
    double t[2] = {0.5, 0.5}, position[2];
    uint32_t square[2];
    if (range[0].tilt != 0.0 || range[1].tilt != 0.0) {
        if (!acdf_grid_square(grid, direction, square, position)) return 0.0f;
        acdf_grid_fractions(grid, direction, position, range, t);
    } else if (local->tables && local->tables->heights)
        return acdf_row_pdf(acdf_local_heights(local->tables), grid->columns, range, p);
    return acdf_grid_pdf(grid, range, t, p);
}

/* The pdf of what rows of codes, or a tree, sample. */
ACDF_FN float acdf_local_spot_pdf(const AcdfLocal* local, const AcdfLocalPoint* point, const float direction[3],
                                  const AcdfLocalSpot* spot) {
    const AcdfGrid grid = acdf_environment_grid(&local->environment);
    const uint32_t* square = spot->square;
    uint32_t told[2];
    AcdfRange range[2];
    double p;
    if (point->what == ACDF_LOCAL_NOTHING || !spot->valid) return 0.0f;
    if (point->what == ACDF_LOCAL_BLEND && spot->piece) return acdf_local_piece_pdf(local, point, spot->piece);
    acdf_sphere_ranges(grid.columns, grid.rows, range);
    if (point->what == ACDF_LOCAL_BLEND) {
        p = acdf_local_blend_find(local, point, spot, range);
    } else {
        if (spot->piece) { /* of tiles, which the tree does not know */
            if (!acdf_local_square(&grid, direction, told)) return 0.0f;
            square = told;
        }
        p = acdf_tree_locate(local->environment.tree, local->environment.tree_units, point->by.root, square, range);
    }
    return p > 0.0 ? acdf_local_cell_pdf(local, &grid, direction, range, p) : 0.0f;
}

/* The cell of a grid square that rows, or a tree, sample at a point, which becomes `range`, and its probability: 0
 * where no sample can fall. */
ACDF_FN double acdf_local_find_cell(const AcdfLocal* local, const AcdfLocalPoint* point, const uint32_t square[2],
                                    AcdfRange range[2]) {
    const AcdfEnvironment* env = &local->environment;
    AcdfLocalSpot spot = {0, {0, 0}, 0, 1};
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
    if (env->halved) {
        AcdfSpan steps[2];
        return acdf_environment_halved_cell(env, square, steps, range);
    }
    if (point->what == ACDF_LOCAL_TREE)
        return acdf_tree_locate(env->tree, env->tree_units, point->by.root, square, range);
    spot.square[0] = square[0];
    spot.square[1] = square[1];
    if (acdf_local_tabled(local))
        spot.tile = acdf_tile_at(acdf_local_words(local->tables), &local->tables->tiles, square);
    return acdf_local_blend_find(local, point, &spot, range);
}

/* Of either, in a direction. */
ACDF_FN float acdf_local_row_pdf(const AcdfLocal* local, const AcdfLocalPoint* point, const float direction[3]) {
    AcdfLocalSpot spot;
    if (point->what == ACDF_LOCAL_NOTHING) return 0.0f;
    if (point->what == ACDF_LOCAL_ROWS) {
        const AcdfGrid grid = acdf_environment_grid(&local->environment);
        const AcdfRowSpot at = acdf_rows_spot(local->rows_of_normals, &grid, direction);
        return acdf_local_rows_pdf(local, point, &grid, &at, direction);
    }
    if (local->environment.halved) return acdf_environment_halved_pdf(&local->environment, direction);
    spot = acdf_local_spot(local, point->what == ACDF_LOCAL_BLEND && acdf_local_tabled(local) ? local->tables : 0,
                           direction);
    return acdf_local_spot_pdf(local, point, direction, &spot);
}

/* Looks from a point that sees portals. */
ACDF_INLINE void acdf_local_eye(const AcdfLocal* local, const AcdfLocalPoint* point, AcdfVisibilityMixture* cells,
                                AcdfPortalEye* out) {
    acdf_local_numbers_of_cells(point, cells);
    acdf_portal_eye(&local->portals, &local->visibility, cells, point->place.portals.position, point->surface, out);
}

/* Of rows and portals together; `row`: that of rows. */
ACDF_OUTLINE_ON_CPU float acdf_local_portals_pdf(const AcdfLocal* local, const AcdfLocalPoint* point,
                                                 const float direction[3], float row) {
    AcdfVisibilityMixture cells;
    AcdfPortalEye eye;
    acdf_local_eye(local, point, &cells, &eye);
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
/* The pdf for a normal of a single call, in files of codes that have tables. */
ACDF_OUTLINE_ON_CPU float acdf_local_new_pdf(const AcdfLocal* local, const float normal[3],
                                             const float direction[3]) {
    const AcdfLocalSpot spot = acdf_local_spot(local, local->tables, direction);
    AcdfLocalPoint point;
    acdf_local_at(local, normal, &point);
    if (point.what == ACDF_LOCAL_NOTHING) return 0.0f;
    return acdf_local_combined_pdf(local, &point, direction, acdf_local_spot_pdf(local, &point, direction, &spot));
}
/* The pdf for a normal of a single call, in any file: through an AcdfLocalPoint. */
ACDF_OUTLINE_ON_CPU float acdf_local_any_new_pdf(const AcdfLocal* local, const float normal[3],
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
    acdf_local_at(local, normal, &point);
    if (point.what != ACDF_LOCAL_ROWS) return acdf_local_pdf_at(local, &point, direction);
    return acdf_local_combined_pdf(local, &point, direction,
                                   acdf_local_rows_pdf(local, &point, &grid, &spot, direction));
}
/* Pdf per steradian with which acdf_local_sample samples `direction` (unit) for that normal. */
ACDF_FN float acdf_local_pdf(const AcdfLocal* local, const float normal[3], const float direction[3]) {
    if (local->rows_of_normals) return acdf_local_new_rows_pdf(local, normal, direction);
    if (local->tables) return acdf_local_new_pdf(local, normal, direction);
    return acdf_local_any_new_pdf(local, normal, direction);
}

#ifdef __cplusplus
}
#endif
#endif
