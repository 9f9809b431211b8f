/* Local environment maps on one tree of halvings: at its top each normal of an octahedron has a row of codes of its
 * own, below that all share (SPEC.md §10.7). A normal samples from the mixture of the rows around it. Part of
 * acdf/local.h.
 *
 * Where codes of rows end there are tiles, numbered in the order of the tree. u[0] chooses a group of tiles that
 * follow one another, u[1] a tile in it: two short searches. Numbers that lead a row to a tile are whole, out of
 * 2^31, and so are weights of rows, out of 2^21: sums of their products are exact in doubles, and the pdf of a
 * direction is the one that samples have. */
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
    uint32_t split;      /* AcdfRowSplit[splits] */
    uint32_t tiles;      /* AcdfTopTile[splits + 1] */
    uint32_t stride;     /* words of a row */
    uint32_t steps;      /* uint32[rows][stride]: the steps that lead to all tiles before each, and to all */
    uint32_t group_bits; /* a group has 2^group_bits tiles, the last one fewer */
    uint32_t groups;
    uint32_t group_stride; /* words of a row of ends */
    uint32_t ends;   /* uint32[rows][group_stride]: the steps that lead to all groups before each, and to all */
    uint32_t bits;   /* the lookup grid has squares of 2^-bits of each axis, in rows of axis 0; 0: there is none */
    uint32_t starts; /* uint32: of each square the deepest split that holds it, or ACDF_TOP_TILE | a tile */
    uint32_t position_scale[2]; /* step * scale / 2^32 is the square of a grid step */
} AcdfNormalRows;

/* The rows around a normal, and what of all samples each has: whole numbers that add up to ACDF_WEIGHTS. */
typedef struct AcdfRowMixture {
    const uint32_t* steps[ACDF_NORMALS_MIXED]; /* to tiles */
    const uint32_t* ends[ACDF_NORMALS_MIXED];  /* to groups */
    double weight[ACDF_NORMALS_MIXED];
} AcdfRowMixture;

/* Mixes rows by weights, some > 0. */
ACDF_INLINE void acdf_rows_mix(const AcdfNormalRows* rows, const uint32_t* row, const double* weight, int count,
                               AcdfRowMixture* out) {
    int i;
    for (i = 0; i < ACDF_NORMALS_MIXED; ++i) {
        const int known = i < count ? i : 0;
        out->steps[i] = ACDF_TOP_ARRAY(uint32_t, rows, rows->steps) + (size_t)row[known] * rows->stride;
        out->ends[i] = ACDF_TOP_ARRAY(uint32_t, rows, rows->ends) + (size_t)row[known] * rows->group_stride;
        out->weight[i] = i < count ? weight[i] : 0.0;
    }
    acdf_whole_weights(out->weight, (uint32_t)count);
}

/* What of a mixture leads to all before an index of its arrays: a whole number, out of 2^52. */
ACDF_INLINE double acdf_rows_before(const AcdfRowMixture* mix, const uint32_t* const* arrays, uint32_t index) {
    double sum = mix->weight[0] * (double)arrays[0][index];
    int k;
    for (k = 1; k < ACDF_NORMALS_MIXED; ++k) sum += mix->weight[k] * (double)arrays[k][index];
    return sum;
}

/* A part of an axis of random numbers: what lies before it, and what of all it has. Out of 2^52. */
typedef struct AcdfRowPart {
    double before, mass;
} AcdfRowPart;

/* The part that *u of `of` leads to, among those from index `low` up to `high`, some of which have a mass. *u is
 * rescaled to [0, 1] in it, and `of` becomes it. Returns its index. */
ACDF_INLINE uint32_t acdf_rows_search(const AcdfRowMixture* mix, const uint32_t* const* arrays, uint32_t low,
                                      uint32_t high, double* u, AcdfRowPart* of) {
    const double x = *u * of->mass, whole = floor(x), at = of->before + (whole < of->mass ? whole : of->mass - 1.0);
    double below = of->before, above = of->before + of->mass;
    while (high - low > 1u) {
        const uint32_t middle = (low + high) >> 1;
        const double before = acdf_rows_before(mix, arrays, middle);
        if (at >= before) low = middle, below = before;
        else high = middle, above = before;
    }
    *u = acdf_clamp((x - (below - of->before)) / (above - below), 0.0, 1.0);
    of->before = below;
    of->mass = above - below;
    return low;
}

/* The tile that u[2] lead to, which are rescaled to [0, 1] in it. *share becomes its part of all. */
ACDF_INLINE const AcdfTopTile* acdf_rows_choose(const AcdfNormalRows* rows, const AcdfRowMixture* mix, double u[2],
                                                double* share) {
    AcdfRowPart part = {0.0, 0x1p52};
    const uint32_t group = acdf_rows_search(mix, mix->ends, 0, rows->groups, &u[0], &part);
    const uint32_t first = group << rows->group_bits, size = 1u << rows->group_bits,
                   left = rows->splits + 1u - first;
    const uint32_t tile =
        acdf_rows_search(mix, mix->steps, first, first + (size < left ? size : left), &u[1], &part);
    *share = part.mass * 0x1p-52;
    return ACDF_TOP_ARRAY(AcdfTopTile, rows, rows->tiles) + tile;
}

/* The tile of a number. */
ACDF_INLINE const AcdfTopTile* acdf_rows_record(const AcdfNormalRows* rows, uint32_t tile) {
    return ACDF_TOP_ARRAY(AcdfTopTile, rows, rows->tiles) + tile;
}

/* The cell of a tile that u[2] lead to; u is rescaled to [0, 1] in it. Returns its pdf where the tile has that
 * probability, sr^-1. */
ACDF_INLINE double acdf_rows_sample_inside(const AcdfHalvedTree* tree, const AcdfGrid* grid,
                                           const AcdfTopTile* tile, double probability, double u[2],
                                           AcdfSpan box[2]) {
    double share;
    box[0] = tile->box[0];
    box[1] = tile->box[1];
    if (tile->node == ACDF_LEAF) return probability * tile->scale;
    share = acdf_tile_descend(acdf_halvings_nodes(tree), tile, u, box);
    return probability * share * acdf_box_scale(acdf_halved_heights(tree), grid, box);
}

/* The same of the cell that holds a grid step of each axis. */
ACDF_INLINE double acdf_rows_find_inside(const AcdfHalvedTree* tree, const AcdfGrid* grid, const AcdfTopTile* tile,
                                         double probability, const uint32_t position[2], AcdfSpan box[2]) {
    double share;
    box[0] = tile->box[0];
    box[1] = tile->box[1];
    if (tile->node == ACDF_LEAF) return probability * tile->scale;
    share = acdf_tile_find(acdf_halvings_nodes(tree), tile, position, box);
    return probability * share * acdf_box_scale(acdf_halved_heights(tree), grid, box);
}

/* The cell that u[2] lead to; u is rescaled to [0, 1] in it. Returns its pdf, sr^-1. */
ACDF_INLINE double acdf_rows_descend(const AcdfNormalRows* rows, const AcdfHalvedTree* tree, const AcdfGrid* grid,
                                     const AcdfRowMixture* mix, double u[2], AcdfSpan box[2]) {
    double here;
    const AcdfTopTile* tile = acdf_rows_choose(rows, mix, u, &here);
    return acdf_rows_sample_inside(tree, grid, tile, here, u, box);
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

/* The same, and the random numbers that lead to the cell. */
ACDF_FN double acdf_rows_strata(const AcdfNormalRows* rows, const AcdfHalvedTree* tree, const AcdfRowMixture* mix,
                                const uint32_t position[2], AcdfRange range[2], AcdfStratum strata[2]) {
    const uint32_t at = acdf_rows_tile(rows, position), group = at >> rows->group_bits;
    const AcdfTopTile* tile = ACDF_TOP_ARRAY(AcdfTopTile, rows, rows->tiles) + at;
    const double before = acdf_rows_before(mix, mix->ends, group),
                 of_group = acdf_rows_before(mix, mix->ends, group + 1u) - before, here = acdf_rows_share(mix, at);
    AcdfSpan box[2], steps[2];
    int axis;
    for (axis = 0; axis < 2; ++axis) steps[axis] = tile->steps[axis], box[axis] = tile->box[axis];
    if (tile->node != ACDF_LEAF) acdf_halvings_find(acdf_halvings_nodes(tree), tile->node, position, steps, box);
    acdf_halved_ranges(box, range);
    if (!(here > 0.0)) return 0.0;
    strata[0].low = before * 0x1p-52;
    strata[0].width = of_group * 0x1p-52;
    strata[1].low = (acdf_rows_before(mix, mix->steps, at) - before) / of_group;
    strata[1].width = here * 0x1p52 / of_group;
    if (tile->node == ACDF_LEAF) return here;
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
    const uint32_t tile = acdf_rows_tile(rows, position);
    return acdf_rows_find_inside(tree, grid, acdf_rows_record(rows, tile), acdf_rows_share(mix, tile), position,
                                 box);
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
