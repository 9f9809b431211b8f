/* Local environment maps and BRDFs on one tree of halvings: at its top each stored normal or view has a row of
 * codes of its own, below that all share (SPEC.md §10.7). Those between sample from a mixture of rows. Part of
 * acdf/local.h and acdf/brdf.h.
 *
 * Where codes of rows end there are tiles, numbered in the order of the tree. u[0] chooses a group of tiles, which
 * is a small tree of splits, by a short search; u[1] goes down that tree, whose codes stand together. Numbers that
 * lead a row to a node are whole, out of 2^31, and so are weights of rows, out of 2^21: sums of their products are
 * exact in doubles, and the pdf of a direction is the one that samples have. */
#ifndef ACDF_NORMAL_ROWS_H
#define ACDF_NORMAL_ROWS_H

#include <acdf/top_tile.h>

#ifdef __cplusplus
extern "C" {
#endif

enum { ACDF_NORMALS_MIXED = 3, ACDF_MOST_ROWS_MIXED = 4 }; /* rows of normals, and of views */
#define ACDF_STEPS_OF_ANY_CODE                                                                                     \
    0x20000u /* any code but the first and the last leads some of so many to both halves */

/* A split at the top of the tree, where each row has a code of its own. They stand in preorder. */
typedef struct AcdfRowSplit {
    uint32_t place;    /* bit 0: axis; bit 1: it is in no group; bits 2 to 31: where it lies, in grid steps */
    uint32_t child[2]; /* lower and upper half: a later split, or ACDF_TOP_TILE | a tile; of splits that are in no
                        * group ACDF_TOP_TILE | a group */
    uint32_t tile;     /* the first tile of the upper half */
} AcdfRowSplit;

/* Tables of an open file, beside its tree of halvings: flat words without pointers, offsets in words from the start
 * of this. */
typedef struct AcdfNormalRows {
    uint32_t words; /* of all */
    uint32_t rows, splits;
    uint32_t split;        /* AcdfRowSplit[splits] */
    uint32_t tiles;        /* AcdfTopTile[splits + 1] */
    uint32_t stride;       /* bytes of a row of codes */
    uint32_t codes;        /* uint8[rows][stride]: of each split; 0 where the row leads no numbers to it */
    uint32_t shares;       /* uint32[256]: acdf_halving_share of each code */
    uint32_t last;         /* code */
    uint32_t groups;       /* of tiles */
    uint32_t group;        /* uint32[groups]: the split, or ACDF_TOP_TILE | the tile, that a group is */
    uint32_t group_stride; /* words of a row of ends */
    uint32_t ends; /* uint32[rows][group_stride]: the steps that lead to all groups before each, and to all */
    uint32_t bits; /* the lookup grid has squares of 2^-bits of each axis, in rows of axis 0; 0: there is none */
    uint32_t
        starts; /* uint32: of each square the deepest split in no group that holds it, or ACDF_TOP_TILE | a group */
    uint32_t position_scale[2]; /* step * scale / 2^32 is the square of a grid step */
} AcdfNormalRows;

/* The rows around a normal or a view, and what of all samples each has: whole numbers that add up to ACDF_WEIGHTS.
 */
typedef struct AcdfRowMixture {
    int count; /* at least one, where there is a mixture */
    const uint8_t* codes[ACDF_MOST_ROWS_MIXED];
    const uint32_t* ends[ACDF_MOST_ROWS_MIXED];
    double weight[ACDF_MOST_ROWS_MIXED];
} AcdfRowMixture;

/* Steps of each row of a mixture. */
typedef struct AcdfRowSteps {
    uint32_t of[ACDF_MOST_ROWS_MIXED];
} AcdfRowSteps;

ACDF_INLINE const AcdfRowSplit* acdf_row_splits(const AcdfNormalRows* rows) {
    return ACDF_TOP_ARRAY(AcdfRowSplit, rows, rows->split);
}
ACDF_INLINE const AcdfTopTile* acdf_row_tile(const AcdfNormalRows* rows, uint32_t tile) {
    return ACDF_TOP_ARRAY(AcdfTopTile, rows, rows->tiles) + tile;
}
/* The split, or ACDF_TOP_TILE | the tile, that a group is. */
ACDF_INLINE uint32_t acdf_row_group(const AcdfNormalRows* rows, uint32_t group) {
    return ACDF_TOP_ARRAY(uint32_t, rows, rows->group)[group];
}
/* A half of a split: a split, or ACDF_TOP_TILE | a tile. */
ACDF_INLINE uint32_t acdf_row_half(const AcdfNormalRows* rows, const AcdfRowSplit* split, uint32_t upper) {
    const uint32_t child = split->child[upper];
    return (split->place & 2u) && (child & ACDF_TOP_TILE) ? acdf_row_group(rows, child & ~ACDF_TOP_TILE) : child;
}

/* Mixes rows by weights, some > 0. */
ACDF_INLINE void acdf_rows_mix(const AcdfNormalRows* rows, const uint32_t* row, const double* weight, int count,
                               AcdfRowMixture* out) {
    uint32_t at;
    int i;
    out->count = count;
    for (i = 0; i < count; ++i) {
        const size_t number = row[i];
        out->codes[i] =
            (const uint8_t*)(const void*)ACDF_TOP_ARRAY(uint32_t, rows, rows->codes) + number * rows->stride;
        out->ends[i] = ACDF_TOP_ARRAY(uint32_t, rows, rows->ends) + number * rows->group_stride;
        out->weight[i] = weight[i];
        for (at = 0; at <= rows->groups; at += 16u) ACDF_PREFETCH(out->ends[i] + at);
    }
    acdf_whole_weights(out->weight, (uint32_t)count);
}

/* What a mixture has of steps of its rows: a whole number, out of 2^52. */
ACDF_INLINE double acdf_rows_mass(const AcdfRowMixture* mix, const AcdfRowSteps* steps) {
    double sum = mix->weight[0] * (double)steps->of[0];
    int k;
    for (k = 1; k < mix->count; ++k) sum += mix->weight[k] * (double)steps->of[k];
    return sum;
}

/* Of so many steps those that a code gives to the lower half. */
ACDF_INLINE uint32_t acdf_row_lower(const uint32_t* shares, uint32_t last, uint32_t code, uint32_t steps) {
    uint32_t lower = (uint32_t)((uint64_t)steps * shares[code] >> 31);
    if (steps < ACDF_STEPS_OF_ANY_CODE && code != 0 && code != last && steps > 0) { /* at least one for each half */
        if (lower == 0) lower = 1;
        if (lower == steps) --lower;
    }
    return lower;
}

/* The steps of the lower half of a split; those of the node become those of the upper half. */
ACDF_INLINE AcdfRowSteps acdf_rows_divide(const AcdfNormalRows* rows, const AcdfRowMixture* mix, uint32_t split,
                                          AcdfRowSteps* steps) {
    const uint32_t* shares = ACDF_TOP_ARRAY(uint32_t, rows, rows->shares);
    AcdfRowSteps lower = {{0, 0, 0, 0}};
    int k;
    k = 0;
    do {
        lower.of[k] = acdf_row_lower(shares, rows->last, mix->codes[k][split], steps->of[k]);
        steps->of[k] -= lower.of[k];
    } while (++k < mix->count);
    return lower;
}

/* The tile below a node of some steps, not all 0, that *u leads to; *u is rescaled to [0, 1] in it, and the steps
 * become its own. */
ACDF_INLINE uint32_t acdf_rows_sample_below(const AcdfNormalRows* rows, const AcdfRowMixture* mix, uint32_t node,
                                            AcdfRowSteps* steps, double* u) {
    const AcdfRowSplit* splits = acdf_row_splits(rows);
    double mass = acdf_rows_mass(mix, steps), x = *u * mass, whole = (double)(int64_t)x, below = 0.0;
    if (!(whole < mass)) whole = mass - 1.0;
    while (!(node & ACDF_TOP_TILE)) {
        const AcdfRowSteps lower = acdf_rows_divide(rows, mix, node, steps);
        const double of_lower = acdf_rows_mass(mix, &lower);
        const uint32_t upper = (uint32_t)(whole - below >= of_lower);
        if (upper) below += of_lower, mass -= of_lower;
        else mass = of_lower, *steps = lower;
        node = acdf_row_half(rows, &splits[node], upper);
    }
    *u = acdf_clamp((x - below) / mass, 0.0, 1.0);
    return node & ~ACDF_TOP_TILE;
}

/* The tile below a node of some steps that holds a grid step of each axis; the steps become its own. */
ACDF_INLINE uint32_t acdf_rows_find_below(const AcdfNormalRows* rows, const AcdfRowMixture* mix, uint32_t node,
                                          AcdfRowSteps* steps, const uint32_t position[2]) {
    const AcdfRowSplit* splits = acdf_row_splits(rows);
    while (!(node & ACDF_TOP_TILE)) {
        const AcdfRowSplit* split = &splits[node];
        const AcdfRowSteps lower = acdf_rows_divide(rows, mix, node, steps);
        const uint32_t upper = (uint32_t)(position[split->place & 1u] >= split->place >> 2);
        if (!upper) *steps = lower;
        node = acdf_row_half(rows, split, upper);
    }
    return node & ~ACDF_TOP_TILE;
}

/* What of a mixture leads to all groups before one. */
ACDF_INLINE double acdf_rows_before(const AcdfRowMixture* mix, uint32_t group) {
    AcdfRowSteps steps = {{0, 0, 0, 0}};
    int k;
    k = 0;
    do steps.of[k] = mix->ends[k][group];
    while (++k < mix->count);
    return acdf_rows_mass(mix, &steps);
}

/* The steps that lead to a group. Asks for its codes. */
ACDF_INLINE AcdfRowSteps acdf_rows_of_group(const AcdfNormalRows* rows, const AcdfRowMixture* mix, uint32_t group) {
    const uint32_t node = acdf_row_group(rows, group);
    AcdfRowSteps steps = {{0, 0, 0, 0}};
    int k;
    k = 0;
    do {
        if (!(node & ACDF_TOP_TILE)) ACDF_PREFETCH(mix->codes[k] + node);
        steps.of[k] = mix->ends[k][group + 1u] - mix->ends[k][group];
    } while (++k < mix->count);
    return steps;
}

/* The group that *u leads to; *u is rescaled to [0, 1] in it. */
ACDF_INLINE uint32_t acdf_rows_sample_group(const AcdfNormalRows* rows, const AcdfRowMixture* mix, double* u) {
    const double x = *u * 0x1p52, whole = (double)(int64_t)x, at = whole < 0x1p52 ? whole : 0x1p52 - 1.0;
    double below = 0.0, above = 0x1p52;
    uint32_t low = 0, high = rows->groups;
    while (high - low > 1u) {
        const uint32_t middle = (low + high) >> 1;
        const double before = acdf_rows_before(mix, middle);
        if (at >= before) low = middle, below = before;
        else high = middle, above = before;
    }
    *u = acdf_clamp((x - below) / (above - below), 0.0, 1.0);
    return low;
}

/* The group that holds a grid step of each axis. */
ACDF_INLINE uint32_t acdf_rows_find_group(const AcdfNormalRows* rows, const uint32_t position[2]) {
    const AcdfRowSplit* splits = acdf_row_splits(rows);
    uint32_t at = rows->groups > 1u ? 0 : ACDF_TOP_TILE;
    if (rows->bits) {
        const uint32_t x = (uint32_t)((uint64_t)position[0] * rows->position_scale[0] >> 32);
        const uint32_t y = (uint32_t)((uint64_t)position[1] * rows->position_scale[1] >> 32);
        at = ACDF_TOP_ARRAY(uint32_t, rows, rows->starts)[y << rows->bits | x];
    }
    while (!(at & ACDF_TOP_TILE)) {
        const AcdfRowSplit* split = &splits[at];
        at = split->child[position[split->place & 1u] >= split->place >> 2];
    }
    return at & ~ACDF_TOP_TILE;
}

/* ---- cells in a tile -------------------------------------------------------------------------------------- */

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

/* A direction that u in [0, 1] pick in a tile of some probability. */
ACDF_INLINE AcdfDirectionSample acdf_rows_direction(const AcdfHalvedTree* tree, const AcdfGrid* grid,
                                                    const AcdfTopTile* tile, double probability, double u[2]) {
    AcdfDirectionSample out;
    AcdfSpan box[2];
    out.pdf = acdf_float_pdf(acdf_rows_sample_inside(tree, grid, tile, probability, u, box));
    acdf_box_direction(acdf_halved_heights(tree), grid, box, u, out.direction);
    return out;
}

/* ---- samples and pdfs ------------------------------------------------------------------------------------- */

/* Samples a direction by u in [0, 1]. */
ACDF_INLINE AcdfDirectionSample acdf_rows_sample(const AcdfNormalRows* rows, const AcdfHalvedTree* tree,
                                                 const AcdfGrid* grid, const AcdfRowMixture* mix, double u[2]) {
    const uint32_t group = acdf_rows_sample_group(rows, mix, &u[0]);
    AcdfRowSteps steps = acdf_rows_of_group(rows, mix, group);
    const uint32_t tile = acdf_rows_sample_below(rows, mix, acdf_row_group(rows, group), &steps, &u[1]);
    return acdf_rows_direction(tree, grid, acdf_row_tile(rows, tile), acdf_rows_mass(mix, &steps) * 0x1p-52, u);
}

/* What a mixture gives to the tile of a group that holds a grid step of each axis, of all. Returns its number. */
ACDF_INLINE uint32_t acdf_rows_find_tile(const AcdfNormalRows* rows, const AcdfRowMixture* mix, uint32_t group,
                                         const uint32_t position[2], double* share) {
    AcdfRowSteps steps = acdf_rows_of_group(rows, mix, group);
    const uint32_t tile = acdf_rows_find_below(rows, mix, acdf_row_group(rows, group), &steps, position);
    *share = acdf_rows_mass(mix, &steps) * 0x1p-52;
    return tile;
}

/* Where a direction lies, which does not depend on the normal: it is looked for first, so that what both need comes
 * at once. */
typedef struct AcdfRowSpot {
    uint32_t square[2], group;
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
    spot.group = acdf_rows_find_group(rows, spot.square);
    return spot;
}

/* The pdf of a cell of a group that holds a grid step of each axis, sr^-1. */
ACDF_INLINE double acdf_rows_cell(const AcdfNormalRows* rows, const AcdfHalvedTree* tree, const AcdfGrid* grid,
                                  const AcdfRowMixture* mix, uint32_t group, const uint32_t position[2],
                                  AcdfSpan box[2]) {
    double share;
    const uint32_t tile = acdf_rows_find_tile(rows, mix, group, position, &share);
    return acdf_rows_find_inside(tree, grid, acdf_row_tile(rows, tile), share, position, box);
}

/* The pdf of a direction, sr^-1: exactly that of acdf_rows_sample where that returned it. */
ACDF_INLINE float acdf_rows_pdf(const AcdfNormalRows* rows, const AcdfHalvedTree* tree, const AcdfGrid* grid,
                                const AcdfRowMixture* mix, const AcdfRowSpot* spot, const float direction[3]) {
    AcdfSpan box[2];
    uint32_t square[2];
    double at[2], p;
    if (!spot->valid) return 0.0f;
    p = acdf_rows_cell(rows, tree, grid, mix, spot->group, spot->square, box);
    if (!spot->nearly ||
        acdf_is_surely_in(spot->position, spot->error, box[0].end[0], box[0].end[1], box[1].end[0], box[1].end[1]))
        return acdf_float_pdf(p);
    if (!acdf_grid_square(grid, direction, square, at)) return 0.0f;
    return acdf_float_pdf(acdf_rows_cell(rows, tree, grid, mix, acdf_rows_find_group(rows, square), square, box));
}

/* The cell that u in [0, 1] lead to, and its probability; they are rescaled to [0, 1] in it. */
ACDF_FN double acdf_rows_choose(const AcdfNormalRows* rows, const AcdfHalvedTree* tree, const AcdfRowMixture* mix,
                                double u[2], AcdfSpan box[2]) {
    const uint32_t group = acdf_rows_sample_group(rows, mix, &u[0]);
    AcdfRowSteps steps = acdf_rows_of_group(rows, mix, group);
    const AcdfTopTile* tile =
        acdf_row_tile(rows, acdf_rows_sample_below(rows, mix, acdf_row_group(rows, group), &steps, &u[1]));
    const double share = acdf_rows_mass(mix, &steps) * 0x1p-52;
    box[0] = tile->box[0];
    box[1] = tile->box[1];
    return tile->node == ACDF_LEAF ? share : share * acdf_tile_descend(acdf_halvings_nodes(tree), tile, u, box);
}

/* The cell that holds a grid step of each axis, and its probability. */
ACDF_FN double acdf_rows_find(const AcdfNormalRows* rows, const AcdfHalvedTree* tree, const AcdfRowMixture* mix,
                              const uint32_t position[2], AcdfSpan box[2]) {
    double share;
    const AcdfTopTile* tile =
        acdf_row_tile(rows, acdf_rows_find_tile(rows, mix, acdf_rows_find_group(rows, position), position, &share));
    box[0] = tile->box[0];
    box[1] = tile->box[1];
    if (tile->node == ACDF_LEAF || !(share > 0.0)) return share;
    return share * acdf_tile_find(acdf_halvings_nodes(tree), tile, position, box);
}

/* The same, and the random numbers that lead to the cell. */
ACDF_FN double acdf_rows_strata(const AcdfNormalRows* rows, const AcdfHalvedTree* tree, const AcdfRowMixture* mix,
                                const uint32_t position[2], AcdfSpan box[2], AcdfStratum strata[2]) {
    const AcdfRowSplit* splits = acdf_row_splits(rows);
    const uint32_t group = acdf_rows_find_group(rows, position);
    AcdfRowSteps steps = acdf_rows_of_group(rows, mix, group);
    const double of_group = acdf_rows_mass(mix, &steps);
    uint32_t node = acdf_row_group(rows, group);
    const AcdfTopTile* tile;
    double below = 0.0, mass;
    AcdfSpan inside[2];
    int axis;
    while (!(node & ACDF_TOP_TILE)) {
        const AcdfRowSplit* split = &splits[node];
        const AcdfRowSteps lower = acdf_rows_divide(rows, mix, node, &steps);
        const uint32_t upper = (uint32_t)(position[split->place & 1u] >= split->place >> 2);
        if (upper) below += acdf_rows_mass(mix, &lower);
        else steps = lower;
        node = acdf_row_half(rows, split, upper);
    }
    tile = acdf_row_tile(rows, node & ~ACDF_TOP_TILE);
    mass = acdf_rows_mass(mix, &steps);
    for (axis = 0; axis < 2; ++axis) inside[axis] = tile->steps[axis], box[axis] = tile->box[axis];
    if (tile->node != ACDF_LEAF) acdf_halvings_find(acdf_halvings_nodes(tree), tile->node, position, inside, box);
    if (!(mass > 0.0)) return 0.0;
    strata[0].low = acdf_rows_before(mix, group) * 0x1p-52;
    strata[0].width = of_group * 0x1p-52;
    strata[1].low = below / of_group;
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
