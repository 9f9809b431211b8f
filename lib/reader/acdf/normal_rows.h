/* Local environment maps on one tree of halvings: at its top each normal of an octahedron has a row of codes of its
 * own, below that all share (SPEC.md §10.7). A normal samples from the mixture of the rows around it. Part of
 * acdf/local.h.
 *
 * Numbers that lead a row to a node are whole, out of 2^31, and so are weights of rows, out of 2^21: as in
 * acdf/indexed.h sums of their products are exact, and the pdf of a direction is the one that samples have. */
#ifndef ACDF_NORMAL_ROWS_H
#define ACDF_NORMAL_ROWS_H

#include <acdf/top_tile.h>

#ifdef __cplusplus
extern "C" {
#endif

enum { ACDF_NORMALS_MIXED = 3 };

/* A split at the top of the tree, where each row has a code of its own. They stand in preorder, and tiles are
 * numbered in the order in which they are met. */
typedef struct AcdfRowSplit {
    uint32_t place;    /* bit 0: axis; bits 1 to 31: where it lies, in grid steps */
    uint32_t tile;     /* the first tile of the upper half */
    uint32_t child[2]; /* lower and upper half: a later split, or ACDF_TOP_TILE | a tile */
} AcdfRowSplit;

/* Tables of an open file, beside its tree of halvings: flat words without pointers, offsets in words from the start
 * of this. */
typedef struct AcdfNormalRows {
    uint32_t words; /* of all */
    uint32_t rows, splits;
    uint32_t split;  /* AcdfRowSplit[splits] */
    uint32_t tiles;  /* AcdfTopTile[splits + 1] */
    uint32_t stride; /* words of a row */
    uint32_t steps;  /* uint32[rows][stride]: the steps that lead to all tiles before each, and to all */
    uint32_t bits;   /* the lookup grid has squares of 2^-bits of each axis, in rows of axis 0; 0: there is none */
    uint32_t starts; /* uint32: of each square the deepest split that holds it, or ACDF_TOP_TILE | a tile */
    uint32_t position_scale[2]; /* step * scale / 2^32 is the square of a grid step */
} AcdfNormalRows;

/* The rows around a normal, and what of all samples each has: whole numbers that add up to ACDF_WEIGHTS. */
typedef struct AcdfRowMixture {
    const uint32_t* steps[ACDF_NORMALS_MIXED];
    double weight[ACDF_NORMALS_MIXED];
} AcdfRowMixture;

/* Mixes rows by weights, some > 0. */
ACDF_INLINE void acdf_rows_mix(const AcdfNormalRows* rows, const uint32_t* row, const double* weight, int count,
                               AcdfRowMixture* out) {
    int i;
    for (i = 0; i < ACDF_NORMALS_MIXED; ++i) {
        const int known = i < count ? i : 0;
        out->steps[i] = ACDF_TOP_ARRAY(uint32_t, rows, rows->steps) + (size_t)row[known] * rows->stride;
        out->weight[i] = i < count ? weight[i] : 0.0;
    }
    acdf_whole_weights(out->weight, (uint32_t)count);
}

/* The cell that u[2] lead to; u is rescaled to [0, 1] in it. Returns its pdf, sr^-1. Until then u[axis] is kept as
 * x[axis] / of[axis], as a division at each level would be slow. */
ACDF_INLINE double acdf_rows_descend(const AcdfNormalRows* rows, const AcdfHalvedTree* tree, const AcdfGrid* grid,
                                     const AcdfRowMixture* mix, double u[2], AcdfSpan box[2]) {
    const AcdfRowSplit* splits = ACDF_TOP_ARRAY(AcdfRowSplit, rows, rows->split);
    uint32_t at = rows->splits ? 0 : ACDF_TOP_TILE, before[ACDF_NORMALS_MIXED] = {0, 0, 0};
    double here = 1.0, share, x[2], of[2];
    const AcdfTopTile* tile;
    int axis, k;
    for (axis = 0; axis < 2; ++axis) x[axis] = u[axis], of[axis] = 1.0;
    while (!(at & ACDF_TOP_TILE)) {
        const AcdfRowSplit* split = &splits[at];
        const uint32_t a = split->place & 1u;
        uint32_t end[ACDF_NORMALS_MIXED];
        double lower = 0.0, border, place;
        for (k = 0; k < ACDF_NORMALS_MIXED; ++k) {
            end[k] = mix->steps[k][split->tile];
            lower += mix->weight[k] * (double)(end[k] - before[k]);
        }
        lower *= 0x1p-52;
        border = lower * of[a];
        place = x[a] * here;
        if (place >= border && here > lower) {
            here -= lower;
            x[a] = place - border;
            at = split->child[1];
            for (k = 0; k < ACDF_NORMALS_MIXED; ++k) before[k] = end[k];
        } else {
            here = lower;
            x[a] = place;
            at = split->child[0];
        }
        of[a] *= here;
        if (of[a] < 0x1p-800) { /* far from what doubles cannot hold */
            of[a] *= 0x1p800;
            x[a] *= 0x1p800;
        }
    }
    tile = ACDF_TOP_ARRAY(AcdfTopTile, rows, rows->tiles) + (at & ~ACDF_TOP_TILE);
    for (axis = 0; axis < 2; ++axis) {
        u[axis] = acdf_clamp(x[axis] / of[axis], 0.0, 1.0);
        box[axis] = tile->box[axis];
    }
    if (tile->node == ACDF_LEAF) return here * tile->scale;
    share = acdf_tile_descend(acdf_halvings_nodes(tree), tile, u, box);
    return here * share * acdf_box_scale(acdf_halved_heights(tree), grid, box);
}

/* The tile that holds a grid step of each axis. */
ACDF_INLINE uint32_t acdf_rows_tile(const AcdfNormalRows* rows, const uint32_t position[2]) {
    const AcdfRowSplit* splits = ACDF_TOP_ARRAY(AcdfRowSplit, rows, rows->split);
    uint32_t at = rows->splits ? 0 : ACDF_TOP_TILE;
    if (rows->bits) {
        const uint32_t x = (uint32_t)((uint64_t)position[0] * rows->position_scale[0] >> 32);
        const uint32_t y = (uint32_t)((uint64_t)position[1] * rows->position_scale[1] >> 32);
        at = ACDF_TOP_ARRAY(uint32_t, rows, rows->starts)[y << rows->bits | x];
    }
    while (!(at & ACDF_TOP_TILE)) {
        const AcdfRowSplit* split = &splits[at];
        at = split->child[position[split->place & 1u] >= split->place >> 1];
    }
    return at & ~ACDF_TOP_TILE;
}

/* What a mixture gives to a tile, of all. */
ACDF_INLINE double acdf_rows_share(const AcdfRowMixture* mix, uint32_t tile) {
    double sum = 0.0;
    int k;
    for (k = 0; k < ACDF_NORMALS_MIXED; ++k)
        sum += mix->weight[k] * (double)(mix->steps[k][tile + 1u] - mix->steps[k][tile]);
    return sum * 0x1p-52;
}

/* The cell that holds a grid step of each axis, and its probability. */
ACDF_INLINE double acdf_rows_find(const AcdfNormalRows* rows, const AcdfHalvedTree* tree, const AcdfRowMixture* mix,
                                  const uint32_t position[2], AcdfSpan box[2]) {
    const uint32_t at = acdf_rows_tile(rows, position);
    const AcdfTopTile* tile = ACDF_TOP_ARRAY(AcdfTopTile, rows, rows->tiles) + at;
    const double here = acdf_rows_share(mix, at);
    box[0] = tile->box[0];
    box[1] = tile->box[1];
    if (tile->node == ACDF_LEAF || !(here > 0.0)) return here;
    return here * acdf_tile_find(acdf_halvings_nodes(tree), tile, position, box);
}

/* The same, and the random numbers that lead to the cell: acdf_rows_descend to a position. */
ACDF_FN double acdf_rows_strata(const AcdfNormalRows* rows, const AcdfHalvedTree* tree, const AcdfRowMixture* mix,
                                const uint32_t position[2], AcdfRange range[2], AcdfStratum strata[2]) {
    const AcdfRowSplit* splits = ACDF_TOP_ARRAY(AcdfRowSplit, rows, rows->split);
    uint32_t at = rows->splits ? 0 : ACDF_TOP_TILE, before[ACDF_NORMALS_MIXED] = {0, 0, 0};
    const AcdfTopTile* tile;
    double here = 1.0;
    AcdfSpan box[2], steps[2];
    int axis, k;
    for (axis = 0; axis < 2; ++axis) strata[axis].low = 0.0, strata[axis].width = 1.0;
    while (!(at & ACDF_TOP_TILE)) {
        const AcdfRowSplit* split = &splits[at];
        AcdfStratum* stratum = &strata[split->place & 1u];
        const uint32_t upper = position[split->place & 1u] >= split->place >> 1;
        double lower = 0.0, of_half;
        for (k = 0; k < ACDF_NORMALS_MIXED; ++k) {
            lower += mix->weight[k] * (double)(mix->steps[k][split->tile] - before[k]) * 0x1p-52;
            if (upper) before[k] = mix->steps[k][split->tile];
        }
        of_half = upper ? here - lower : lower;
        if (upper) stratum->low += stratum->width * (here > 0.0 ? lower / here : 0.0);
        stratum->width *= here > 0.0 ? of_half / here : 0.0;
        here = of_half;
        at = split->child[upper];
    }
    tile = ACDF_TOP_ARRAY(AcdfTopTile, rows, rows->tiles) + (at & ~ACDF_TOP_TILE);
    for (axis = 0; axis < 2; ++axis) steps[axis] = tile->steps[axis], box[axis] = tile->box[axis];
    if (tile->node != ACDF_LEAF) acdf_halvings_find(acdf_halvings_nodes(tree), tile->node, position, steps, box);
    acdf_halved_ranges(box, range);
    if (tile->node == ACDF_LEAF || !(here > 0.0)) return here;
    for (axis = 0; axis < 2; ++axis) {
        const double wide = (double)(tile->steps[axis].end[1] - tile->steps[axis].end[0]);
        strata[axis].low += strata[axis].width * ((double)(steps[axis].end[0] - tile->steps[axis].end[0]) / wide);
        strata[axis].width *= (double)(steps[axis].end[1] - steps[axis].end[0]) / wide;
    }
    return here * (acdf_steps_in(steps) / acdf_steps_in(tile->steps));
}

/* Samples a direction by u in [0, 1]. */
ACDF_INLINE AcdfDirectionSample acdf_rows_sample(const AcdfNormalRows* rows, const AcdfHalvedTree* tree,
                                                 const AcdfGrid* grid, const AcdfRowMixture* mix, double u[2]) {
    AcdfDirectionSample out;
    AcdfSpan box[2];
    const double p = acdf_rows_descend(rows, tree, grid, mix, u, box);
    acdf_box_direction(acdf_halved_heights(tree), grid, box, u, out.direction);
    out.pdf = acdf_float_pdf(p);
    return out;
}

/* The pdf of a cell that holds a grid step of each axis, sr^-1. */
ACDF_INLINE double acdf_rows_cell(const AcdfNormalRows* rows, const AcdfHalvedTree* tree, const AcdfGrid* grid,
                                  const AcdfRowMixture* mix, const uint32_t position[2], AcdfSpan box[2]) {
    const uint32_t at = acdf_rows_tile(rows, position);
    const AcdfTopTile* tile = ACDF_TOP_ARRAY(AcdfTopTile, rows, rows->tiles) + at;
    const double here = acdf_rows_share(mix, at);
    double share;
    box[0] = tile->box[0];
    box[1] = tile->box[1];
    if (tile->node == ACDF_LEAF) return here * tile->scale;
    share = acdf_tile_find(acdf_halvings_nodes(tree), tile, position, box);
    return here * share * acdf_box_scale(acdf_halved_heights(tree), grid, box);
}

/* The pdf of a direction, sr^-1: exactly that of acdf_rows_sample where that returned it. */
ACDF_INLINE float acdf_rows_pdf(const AcdfNormalRows* rows, const AcdfHalvedTree* tree, const AcdfGrid* grid,
                                const AcdfRowMixture* mix, const float direction[3]) {
    float position[2], error[2];
    double at[2];
    uint32_t square[2];
    AcdfSpan box[2];
    if (!acdf_grid_is_octahedral(grid) &&
        acdf_sphere_nearly(grid->columns, grid->rows, direction, position, error)) {
        double p;
        square[0] = (uint32_t)position[0] < grid->columns ? (uint32_t)position[0] : grid->columns - 1u;
        square[1] = (uint32_t)position[1] < grid->rows ? (uint32_t)position[1] : grid->rows - 1u;
        p = acdf_rows_cell(rows, tree, grid, mix, square, box);
        if (acdf_is_surely_in(position, error, box[0].end[0], box[0].end[1], box[1].end[0], box[1].end[1]))
            return acdf_float_pdf(p);
    }
    if (!acdf_grid_square(grid, direction, square, at)) return 0.0f;
    return acdf_float_pdf(acdf_rows_cell(rows, tree, grid, mix, square, box));
}

#ifdef __cplusplus
}
#endif
#endif
