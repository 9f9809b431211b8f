/* Local environment maps and BRDFs on one tree of halvings: at its top each stored normal or view has a row of
 * codes of its own, below that all share (SPEC.md §9). Those between sample from a mixture of rows. Part of
 * acdf/local.h and acdf/brdf.h.
 *
 * Where codes of rows end there are tiles, numbered in the order of the tree. Of each row the steps of random
 * numbers that lead to all tiles before each are kept: whole numbers, out of 2^31. u[0] chooses a group of tiles,
 * u[1] one of the group. Weights of rows are whole numbers, too, out of 2^21: sums of their products are exact in
 * doubles, and the pdf of a direction is the one that samples have. */
#ifndef ACDF_NORMAL_ROWS_H
#define ACDF_NORMAL_ROWS_H

#include <acdf/top_tile.h>

#ifdef __cplusplus
extern "C" {
#endif

enum { ACDF_NORMALS_MIXED = 3, ACDF_MOST_ROWS_MIXED = 4 }; /* rows of normals, and of views */

/* A split at the top of the tree. They stand in preorder. */
typedef struct AcdfRowSplit {
    uint32_t place;    /* bit 0: axis; bits 1 to 31: where it lies, in grid steps */
    uint32_t child[2]; /* lower and upper half: a later split, or ACDF_TOP_TILE | a tile */
    uint32_t tile;     /* the first tile of the upper half */
} AcdfRowSplit;

/* Tables of an open file, beside its tree of halvings: flat words without pointers, offsets in words from the start
 * of this. */
typedef struct AcdfNormalRows {
    uint32_t words; /* of all */
    uint32_t rows, splits;
    uint32_t split;        /* AcdfRowSplit[splits] */
    uint32_t tiles;        /* AcdfTopTile[splits + 1] */
    uint32_t stride;       /* words of a row of `before` */
    uint32_t before;       /* uint32[rows][stride]: the steps that lead to all tiles before each, and to all */
    uint32_t groups;       /* of tiles that follow each other */
    uint32_t first;        /* uint32[groups + 1]: the first tile of each, and how many tiles there are */
    uint32_t group_stride; /* words of a row of `ends` */
    uint32_t ends;         /* uint32[rows][group_stride]: `before` of the first tile of each group, and of all */
    uint32_t bits;         /* the lookup grid has squares of 2^-bits of each axis, in rows of axis 0; 0: none */
    uint32_t starts;       /* uint32: of each square the deepest split that holds it, or ACDF_TOP_TILE | a tile */
    uint32_t position_scale[2]; /* step * scale / 2^32 is the square of a grid step */
} AcdfNormalRows;

/* Rows, and what of all samples each has: whole numbers that add up to ACDF_WEIGHTS. */
typedef struct AcdfRowMixture {
    int count; /* at least one, where there is a mixture */
    const uint32_t* before[ACDF_MOST_ROWS_MIXED];
    const uint32_t* ends[ACDF_MOST_ROWS_MIXED];
    uint32_t weight[ACDF_MOST_ROWS_MIXED];
} AcdfRowMixture;

ACDF_INLINE const AcdfRowSplit* acdf_row_splits(const AcdfNormalRows* rows) {
    return ACDF_TOP_ARRAY(AcdfRowSplit, rows, rows->split);
}
ACDF_INLINE const AcdfTopTile* acdf_row_tile(const AcdfNormalRows* rows, uint32_t tile) {
    return ACDF_TOP_ARRAY(AcdfTopTile, rows, rows->tiles) + tile;
}
ACDF_INLINE const uint32_t* acdf_row_first(const AcdfNormalRows* rows) {
    return ACDF_TOP_ARRAY(uint32_t, rows, rows->first);
}
ACDF_INLINE const uint32_t* acdf_row_before(const AcdfNormalRows* rows, uint32_t row) {
    return ACDF_TOP_ARRAY(uint32_t, rows, rows->before) + (size_t)row * rows->stride;
}

/* Mixes rows by weights, which are all > 0. */
ACDF_INLINE void acdf_rows_mix(const AcdfNormalRows* rows, const uint32_t* row, const double* weight, int count,
                               AcdfRowMixture* out) {
    uint32_t at;
    int i;
    out->count = count;
    for (i = 0; i < count; ++i) {
        out->before[i] = acdf_row_before(rows, row[i]);
        out->ends[i] = ACDF_TOP_ARRAY(uint32_t, rows, rows->ends) + (size_t)row[i] * rows->group_stride;
        for (at = 0; at <= rows->groups; at += 16u) ACDF_PREFETCH(out->ends[i] + at);
    }
    acdf_whole_weights(weight, (uint32_t)count, out->weight);
}

/* What a row has of the samples of a mixture that it is the k-th of, out of ACDF_WEIGHTS. */
ACDF_INLINE double acdf_rows_weight(const AcdfRowMixture* mix, int k) { return (double)(int32_t)mix->weight[k]; }

/* What a mixture has of the steps that stand at a place of its rows: a whole number, out of 2^52. */
ACDF_INLINE double acdf_rows_sum(const AcdfRowMixture* mix, const uint32_t* const* rows, uint32_t at) {
    double sum = acdf_rows_weight(mix, 0) * (double)rows[0][at];
    int k;
    for (k = 1; k < mix->count; ++k) sum += acdf_rows_weight(mix, k) * (double)rows[k][at];
    return sum;
}
/* What it gives to tiles [first, end). */
ACDF_INLINE double acdf_rows_mass(const AcdfRowMixture* mix, uint32_t first, uint32_t end) {
    return acdf_rows_sum(mix, mix->before, end) - acdf_rows_sum(mix, mix->before, first);
}

/* Which of [first, end) *u leads to, where rows have ends of it: of all, *below lie before `first` and *mass, not
 * 0, in them. These become the ones of what is found, and *u is rescaled to [0, 1] in it. */
ACDF_INLINE uint32_t acdf_rows_search(const AcdfRowMixture* mix, const uint32_t* const* rows, uint32_t first,
                                      uint32_t end, double* below, double* mass, double* u) {
    const double x = *u * *mass, down = (double)(int64_t)x, whole = down < *mass ? down : *mass - 1.0;
    const double at = *below + whole;
    double low, high;
    while (end - first > 1u) { /* seven borders at once: no load waits for a comparison, and no branch for either */
        const uint32_t step = (end - first + 7u) >> 3;
        uint32_t found = first, i;
        for (i = 1; i < 8u; ++i) {
            const uint32_t border = first + i * step;
            found += step & (0u - (uint32_t)(acdf_rows_sum(mix, rows, border < end ? border : end) <= at));
        }
        first = found;
        end = first + step < end ? first + step : end;
    }
    low = acdf_rows_sum(mix, rows, first);
    high = acdf_rows_sum(mix, rows, end);
    *u = acdf_clamp((x - (low - *below)) / (high - low), 0.0, 1.0);
    *below = low;
    *mass = high - low;
    return first;
}

/* The tile that u[2] lead to, and what of all samples it has; u[1] is rescaled to [0, 1] in it, u[0] in its group.
 */
ACDF_INLINE const AcdfTopTile* acdf_rows_sample_tile(const AcdfNormalRows* rows, const AcdfRowMixture* mix,
                                                     double u[2], double* share) {
    double below = 0.0, mass = 0x1p52;
    const uint32_t group = acdf_rows_search(mix, mix->ends, 0, rows->groups, &below, &mass, &u[0]);
    const uint32_t* first = acdf_row_first(rows) + group;
    const uint32_t tile = acdf_rows_search(mix, mix->before, first[0], first[1], &below, &mass, &u[1]);
    *share = mass * 0x1p-52;
    return acdf_row_tile(rows, tile);
}

/* The tile below a split, or ACDF_TOP_TILE | a tile, that holds a grid step of each axis. */
ACDF_INLINE uint32_t acdf_rows_find_below(const AcdfNormalRows* rows, uint32_t node, const uint32_t position[2]) {
    const AcdfRowSplit* splits = acdf_row_splits(rows);
    while (!(node & ACDF_TOP_TILE)) {
        const AcdfRowSplit* split = &splits[node];
        node = split->child[position[split->place & 1u] >= split->place >> 1];
    }
    return node & ~ACDF_TOP_TILE;
}

/* The tile that holds a grid step of each axis. */
ACDF_INLINE uint32_t acdf_rows_find_tile(const AcdfNormalRows* rows, const uint32_t position[2]) {
    uint32_t at = rows->splits ? 0 : ACDF_TOP_TILE;
    if (rows->bits) {
        const uint32_t x = (uint32_t)((uint64_t)position[0] * rows->position_scale[0] >> 32);
        const uint32_t y = (uint32_t)((uint64_t)position[1] * rows->position_scale[1] >> 32);
        at = ACDF_TOP_ARRAY(uint32_t, rows, rows->starts)[y << rows->bits | x];
    }
    return acdf_rows_find_below(rows, at, position);
}

/* ---- cells in a tile -------------------------------------------------------------------------------------- */

/* A cell of a tile: what of the tile's samples it has, and its pdf over its probability, sr^-1. */
typedef struct AcdfRowCell {
    double share, scale;
    AcdfSpan box[2];
} AcdfRowCell;

/* The cell of a tile that u[2] lead to; u is rescaled to [0, 1] in it. */
ACDF_INLINE AcdfRowCell acdf_rows_sample_cell(const AcdfHalvedTree* tree, const AcdfGrid* grid,
                                              const AcdfTopTile* tile, double u[2]) {
    AcdfRowCell out;
    out.share = acdf_tile_sample(acdf_halvings_nodes(tree), tile, u, out.box);
    out.scale = acdf_tile_scale(acdf_halved_heights(tree), grid, tile, out.box);
    return out;
}

/* The one that holds a grid step of each axis. */
ACDF_INLINE AcdfRowCell acdf_rows_find_cell(const AcdfHalvedTree* tree, const AcdfGrid* grid,
                                            const AcdfTopTile* tile, const uint32_t position[2]) {
    AcdfRowCell out;
    out.share = acdf_tile_find(acdf_halvings_nodes(tree), tile, position, out.box);
    out.scale = acdf_tile_scale(acdf_halved_heights(tree), grid, tile, out.box);
    return out;
}

/* A direction that u in [0, 1] pick in a tile of some probability. */
ACDF_INLINE AcdfDirectionSample acdf_rows_direction(const AcdfHalvedTree* tree, const AcdfGrid* grid,
                                                    const AcdfTopTile* tile, double probability, double u[2]) {
    AcdfDirectionSample out;
    const AcdfRowCell cell = acdf_rows_sample_cell(tree, grid, tile, u);
    out.pdf = acdf_float_pdf(probability * cell.share * cell.scale);
    acdf_box_direction(acdf_halved_heights(tree), grid, cell.box, u, out.direction);
    return out;
}

/* ---- samples and pdfs ------------------------------------------------------------------------------------- */

/* Samples a direction by u in [0, 1]. */
ACDF_INLINE AcdfDirectionSample acdf_rows_sample(const AcdfNormalRows* rows, const AcdfHalvedTree* tree,
                                                 const AcdfGrid* grid, const AcdfRowMixture* mix, double u[2]) {
    double share;
    const AcdfTopTile* tile = acdf_rows_sample_tile(rows, mix, u, &share);
    return acdf_rows_direction(tree, grid, tile, share, u);
}

/* Where a direction lies, which does not depend on the normal: it is looked for first, so that what both need comes
 * at once. */
typedef struct AcdfRowSpot {
    uint32_t square[2], tile;
    float position[2], error[2]; /* of floats, where they are near enough */
    int nearly, valid;
} AcdfRowSpot;

ACDF_INLINE AcdfRowSpot acdf_rows_spot(const AcdfNormalRows* rows, const AcdfGrid* grid, const float direction[3]) {
    AcdfRowSpot spot = {{0, 0}, 0, {0.0f, 0.0f}, {0.0f, 0.0f}, 0, 1};
    double at[2];
    if (!acdf_grid_is_octahedral(grid))
        spot.nearly = acdf_sphere_nearly(grid->columns, grid->rows, direction, spot.position, spot.error);
    if (spot.nearly) {
        spot.square[0] =
            (uint32_t)spot.position[0] < grid->columns ? (uint32_t)spot.position[0] : grid->columns - 1u;
        spot.square[1] = (uint32_t)spot.position[1] < grid->rows ? (uint32_t)spot.position[1] : grid->rows - 1u;
    } else {
        spot.valid = acdf_grid_square(grid, direction, spot.square, at);
        if (!spot.valid) return spot;
    }
    spot.tile = acdf_rows_find_tile(rows, spot.square);
    return spot;
}

/* The tile and the cell of a direction, in doubles: right at borders, too. */
typedef struct AcdfRowFound {
    int valid; /* 0: it is no direction */
    uint32_t tile;
    AcdfRowCell cell;
} AcdfRowFound;

ACDF_OUTLINE_ON_CPU AcdfRowFound acdf_rows_at_border(const AcdfNormalRows* rows, const AcdfHalvedTree* tree,
                                                     const AcdfGrid* grid, const float direction[3]) {
    AcdfRowFound out = {0, 0, {0.0, 0.0, {{{0, 0}}, {{0, 0}}}}};
    uint32_t square[2];
    double at[2];
    if (!acdf_grid_square(grid, direction, square, at)) return out;
    out.valid = 1;
    out.tile = acdf_rows_find_tile(rows, square);
    out.cell = acdf_rows_find_cell(tree, grid, acdf_row_tile(rows, out.tile), square);
    return out;
}

/* The cell of a direction, and its tile: what floats found, where that is sure. 0: it is no direction. */
ACDF_INLINE int acdf_rows_locate(const AcdfNormalRows* rows, const AcdfHalvedTree* tree, const AcdfGrid* grid,
                                 AcdfRowSpot* spot, const float direction[3], AcdfRowCell* cell) {
    AcdfRowFound found;
    if (!spot->valid) return 0;
    *cell = acdf_rows_find_cell(tree, grid, acdf_row_tile(rows, spot->tile), spot->square);
    if (!spot->nearly || acdf_is_surely_in(spot->position, spot->error, cell->box[0].end[0], cell->box[0].end[1],
                                           cell->box[1].end[0], cell->box[1].end[1]))
        return 1;
    found = acdf_rows_at_border(rows, tree, grid, direction);
    spot->tile = found.tile;
    *cell = found.cell;
    return found.valid;
}

/* The cell that u in [0, 1] lead to, and its probability; they are rescaled to [0, 1] in it. */
ACDF_FN double acdf_rows_choose(const AcdfNormalRows* rows, const AcdfHalvedTree* tree, const AcdfRowMixture* mix,
                                double u[2], AcdfSpan box[2]) {
    double share;
    const AcdfTopTile* tile = acdf_rows_sample_tile(rows, mix, u, &share);
    return share * acdf_tile_sample(acdf_halvings_nodes(tree), tile, u, box);
}

/* The cell that holds a grid step of each axis, and its probability. */
ACDF_FN double acdf_rows_find(const AcdfNormalRows* rows, const AcdfHalvedTree* tree, const AcdfRowMixture* mix,
                              const uint32_t position[2], AcdfSpan box[2]) {
    const uint32_t number = acdf_rows_find_tile(rows, position);
    const AcdfTopTile* tile = acdf_row_tile(rows, number);
    const double share = acdf_rows_mass(mix, number, number + 1u) * 0x1p-52;
    return share * acdf_tile_find(acdf_halvings_nodes(tree), tile, position, box);
}

/* The same, and the random numbers that lead to the cell. */
ACDF_FN double acdf_rows_strata(const AcdfNormalRows* rows, const AcdfHalvedTree* tree, const AcdfRowMixture* mix,
                                const uint32_t position[2], AcdfSpan box[2], AcdfStratum strata[2]) {
    const uint32_t number = acdf_rows_find_tile(rows, position), *first = acdf_row_first(rows);
    const AcdfTopTile* tile = acdf_row_tile(rows, number);
    const double mass = acdf_rows_mass(mix, number, number + 1u);
    double before, of_group;
    uint32_t group = 0;
    AcdfSpan inside[2];
    int axis;
    while (first[group + 1u] <= number) ++group;
    before = acdf_rows_sum(mix, mix->ends, group);
    of_group = acdf_rows_sum(mix, mix->ends, group + 1u) - before;
    for (axis = 0; axis < 2; ++axis) inside[axis] = tile->steps[axis], box[axis] = tile->box[axis];
    if (tile->node != ACDF_LEAF) acdf_halvings_find(acdf_halvings_nodes(tree), tile->node, position, inside, box);
    if (!(mass > 0.0)) return 0.0;
    strata[0].low = before * 0x1p-52;
    strata[0].width = of_group * 0x1p-52;
    strata[1].low = (acdf_rows_sum(mix, mix->before, number) - before) / of_group;
    strata[1].width = mass / of_group;
    if (tile->node == ACDF_LEAF) return mass * 0x1p-52;
    for (axis = 0; axis < 2; ++axis) {
        const double wide = (double)(tile->steps[axis].end[1] - tile->steps[axis].end[0]);
        strata[axis].low += strata[axis].width * ((double)(inside[axis].end[0] - tile->steps[axis].end[0]) / wide);
        strata[axis].width *= (double)(inside[axis].end[1] - inside[axis].end[0]) / wide;
    }
    return mass * 0x1p-52 * (acdf_steps_in(inside) / acdf_steps_in(tile->steps));
}

#ifdef __cplusplus
}
#endif
#endif
