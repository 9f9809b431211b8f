/* Runtime tables of an environment that has too many cells for those of acdf/cells.h: in less than half of the
 * bytes, and with two searches instead of one. Made once at load (acdf/reader.h); flat without pointers.
 *
 * Cells that are next to each other in the tree make groups, which are boxes of random numbers and of positions as
 * cells are. Two grids lead to a group (acdf/squares.h); in it, the numbers that are left and the positions, which
 * count from its corner in bytes, are compared with the boxes of its cells. No cell is cut.
 *
 * As in acdf/cells.h the tables only answer where they are sure that the walk of the tree finds the same cell. */
#ifndef ACDF_GROUPS_H
#define ACDF_GROUPS_H

#include <acdf/row_heights.h>
#include <acdf/squares.h>

#ifdef __cplusplus
extern "C" {
#endif

/* Up to some dozens of cells, in a cache line. */
typedef struct AcdfGroup {
    double low[2], scale[2];    /* (u - low) * scale is what is left of random numbers; others are not in [0, 1) */
    uint32_t first[2], last[2]; /* positions; not more than 255 steps, nor half of all, but where it is one cell */
    uint32_t cells, count;      /* the number of its first cell, and how many there are */
    uint32_t more;              /* the number of its second block of 16 cells, if it has one */
    uint32_t reserved;
} AcdfGroup;
ACDF_STATIC_ASSERT(sizeof(AcdfGroup) == 64);

/* Of a cell: the numbers that lead to it, (v - low) * scale, of what v is left in its group in steps of 2^-32. */
typedef struct AcdfGroupAxis {
    uint32_t low;
    float scale; /* 1: all of it is margin, too narrow to be sure where in it a number leads */
} AcdfGroupAxis;
typedef struct AcdfGroupCell {
    AcdfGroupAxis axis[2];
} AcdfGroupCell;

/* Offsets in words from the start of this struct, which the arrays follow. */
typedef struct AcdfGroups {
    uint32_t words;      /* of all */
    uint32_t count;      /* of cells */
    AcdfSquares numbers; /* of groups; keys: u in steps of 2^-31 */
    AcdfSquares places;  /* of groups; keys: squares of the grid of positions, times 2^shift */
    uint32_t shift[2];
    uint32_t groups; /* AcdfGroup */
    uint32_t boxes;  /* ACDF_GROUP_WORDS a group, of its first 16 cells: as of AcdfSquares, of v in steps of 2^-8,
                        and of positions; of groups of one cell there are none */
    uint32_t more;   /* the same of other blocks of 16 cells */
    uint32_t cells;  /* AcdfGroupCell, `count` of them */
    uint32_t densities; /* f32, sr^-1; 0: no sample falls there */
    uint32_t heights;   /* f64, acdf_row_z of each border between rows; 0 on the octahedral square */
    uint32_t reserved[4];
} AcdfGroups;
ACDF_STATIC_ASSERT(sizeof(AcdfGroups) == 128);

#define ACDF_GROUP_WORDS 32u
#define ACDF_GROUP_POSITIONS 16u /* where those of positions begin */
/* Numbers closer to the border of a cell, in steps of 2^-32 of the group, are left to the walk: more than they
 * and `low` are rounded. */
#define ACDF_GROUP_MARGIN 2u

ACDF_INLINE const uint32_t* acdf_group_words(const AcdfGroups* groups, uint32_t offset) {
    return (const uint32_t*)(const void*)groups + offset;
}
/* What is asked of a group next comes with it. */
ACDF_INLINE const AcdfGroup* acdf_group_at(const AcdfGroups* groups, uint32_t i, uint32_t half) {
    ACDF_PREFETCH(acdf_group_words(groups, groups->boxes + ACDF_GROUP_WORDS * i + half));
    return (const AcdfGroup*)(const void*)acdf_group_words(groups, groups->groups) + i;
}
ACDF_INLINE uint32_t acdf_group_number(const AcdfGroups* groups, const AcdfGroup* group) {
    return (uint32_t)(group - (const AcdfGroup*)(const void*)acdf_group_words(groups, groups->groups));
}
/* Of the block that begins with cell `first`. */
ACDF_INLINE const uint32_t* acdf_group_boxes(const AcdfGroups* groups, const AcdfGroup* group, uint32_t first) {
    const uint32_t block =
        first == 0 ? acdf_group_number(groups, group) : group->more + first / ACDF_BLOCK_CELLS - 1u;
    return acdf_group_words(groups, (first == 0 ? groups->boxes : groups->more) + ACDF_GROUP_WORDS * block);
}
ACDF_INLINE float acdf_group_density(const AcdfGroups* groups, uint32_t cell) {
    return ((const float*)(const void*)acdf_group_words(groups, groups->densities))[cell];
}

/* ---- drawing ---------------------------------------------------------------------------------------- */

/* The positions of cell i of a block whose boxes of positions begin at a word. */
ACDF_INLINE void acdf_group_range(const AcdfGroup* group, const uint32_t* boxes, uint32_t i, AcdfRange range[2]) {
    const uint8_t* bytes = (const uint8_t*)(const void*)boxes + i;
    int axis;
    for (axis = 0; axis < 2; ++axis) {
        range[axis].low = group->first[axis] + (bytes[32 * axis] ^ 0x80u);
        range[axis].high = group->first[axis] + (bytes[32 * axis + 16] ^ 0x80u) + 1u;
        range[axis].tilt = 0.0;
    }
}

/* How far numbers, in steps of 2^-32 of the group, are across a cell: not below 1 next to its borders. */
ACDF_INLINE double acdf_group_across(const AcdfGroupAxis* axis, uint32_t number) {
    const double scale = (double)axis->scale, margin = (double)ACDF_GROUP_MARGIN * scale;
    const double past = (double)(int64_t)(uint32_t)(number - axis->low - ACDF_GROUP_MARGIN) * scale;
    return past < 1.0 - 2.0 * margin ? past + margin : 1.0;
}

/* Which cell of a group is drawn by what is left of the numbers, in steps of 2^-52: its number, where it lies, and
 * what is left in it. Returns 0 next to the borders of cells. */
ACDF_INLINE int acdf_group_draw(const AcdfGroups* groups, const AcdfGroup* group, const uint64_t n[2], double u[2],
                                AcdfRange range[2], uint32_t* cell) {
    const AcdfGroupCell* cells =
        (const AcdfGroupCell*)(const void*)acdf_group_words(groups, groups->cells) + group->cells;
    uint32_t first;
    for (first = 0; first < group->count; first += ACDF_BLOCK_CELLS) {
        const uint32_t* boxes = acdf_group_boxes(groups, group, first);
        uint32_t mask = acdf_squares_candidates(boxes, (uint32_t)(n[0] >> 44), (uint32_t)(n[1] >> 44));
        for (; mask; mask &= mask - 1) {
            const uint32_t i = acdf_lowest_bit(mask);
            const double across0 = acdf_group_across(&cells[first + i].axis[0], (uint32_t)(n[0] >> 20));
            const double across1 = acdf_group_across(&cells[first + i].axis[1], (uint32_t)(n[1] >> 20));
            if (!((across0 < 1.0) & (across1 < 1.0))) continue;
            acdf_group_range(group, boxes + ACDF_GROUP_POSITIONS, i, range);
            u[0] = across0;
            u[1] = across1;
            *cell = group->cells + first + i;
            return 1;
        }
    }
    return 0;
}

/* The group to which random numbers lead, and what is left of them in steps of 2^-52; null where the grids know
 * none, and for numbers not in [0, 1). */
ACDF_INLINE const AcdfGroup* acdf_group_of_numbers(const AcdfGroups* groups, double u0, double u1,
                                                   uint64_t left[2]) {
    const uint16_t* found;
    uint32_t mask;
    if (!acdf_number_steps(u0, u1, left)) return 0;
    mask = acdf_squares_find(acdf_group_words(groups, 0), &groups->numbers, (uint32_t)(left[0] >> 21),
                             (uint32_t)(left[1] >> 21), &found);
    for (; mask; mask &= mask - 1) {
        const AcdfGroup* group = acdf_group_at(groups, found[acdf_lowest_bit(mask)], 0u);
        if (acdf_number_steps((u0 - group->low[0]) * group->scale[0], (u1 - group->low[1]) * group->scale[1], left))
            return group;
    }
    return 0;
}

/* Draws a direction on a grid, with acdf_environment_sample's contract. Returns 0, and leaves `out`, where the tree
 * must be walked. */
ACDF_INLINE int acdf_groups_sample(const AcdfGroups* groups, const AcdfGrid* grid, double u0, double u1,
                                   AcdfDirectionSample* out) {
    uint64_t left[2];
    double u[2];
    AcdfRange range[2];
    uint32_t cell;
    const AcdfGroup* group = acdf_group_of_numbers(groups, u0, u1, left);
    if (!group) return 0;
    if (group->count == 1) {
        cell = group->cells;
        acdf_sphere_ranges(group->last[0], group->last[1], range);
        range[0].low = group->first[0];
        range[1].low = group->first[1];
        u[0] = (double)(int64_t)left[0] * 0x1p-52;
        u[1] = (double)(int64_t)left[1] * 0x1p-52;
    } else if (!acdf_group_draw(groups, group, left, u, range, &cell)) {
        return 0;
    }
    if (groups->heights ? !acdf_row_direction((const double*)(const void*)acdf_group_words(groups, groups->heights),
                                              grid->columns, range, u, out->direction)
                        : !acdf_fold_direction(grid, range, u, out->direction))
        return 0;
    out->pdf = acdf_group_density(groups, cell);
    return 1;
}

/* ---- finding ---------------------------------------------------------------------------------------- */

/* The cell of a group that holds a position `at` from its corner; `count` where it lies elsewhere. */
ACDF_INLINE uint32_t acdf_group_locate(const AcdfGroups* groups, const AcdfGroup* group, uint32_t at0,
                                       uint32_t at1) {
    uint32_t first;
    if (group->count == 1) return 0;
    for (first = 0; first < group->count; first += ACDF_BLOCK_CELLS) {
        const uint32_t mask =
            acdf_squares_candidates(acdf_group_boxes(groups, group, first) + ACDF_GROUP_POSITIONS, at0, at1);
        if (mask) return first + acdf_lowest_bit(mask);
    }
    return group->count;
}

/* The density of a direction on a grid into *pdf. Returns 0 where the tree must be walked: next to the borders of
 * the grid's squares, and where floats tell nothing. */
ACDF_INLINE int acdf_groups_pdf(const AcdfGroups* groups, const AcdfGrid* grid, const float direction[3],
                                float* pdf) {
    const uint16_t* found;
    uint32_t square[2], mask;
    if (!(groups->heights ? acdf_row_square(grid->columns, grid->rows, direction, square)
                          : acdf_fold_square(grid->columns, grid->rows, direction, square)))
        return 0;
    mask = acdf_squares_find(acdf_group_words(groups, 0), &groups->places, square[0] << groups->shift[0],
                             square[1] << groups->shift[1], &found);
    for (; mask; mask &= mask - 1) {
        const AcdfGroup* group = acdf_group_at(groups, found[acdf_lowest_bit(mask)], ACDF_GROUP_POSITIONS);
        const uint32_t at0 = square[0] - group->first[0], at1 = square[1] - group->first[1];
        uint32_t cell;
        if (!((at0 < group->last[0] - group->first[0]) & (at1 < group->last[1] - group->first[1]))) continue;
        cell = acdf_group_locate(groups, group, at0, at1);
        if (cell >= group->count) return 0;
        *pdf = acdf_group_density(groups, group->cells + cell);
        return 1;
    }
    return 0;
}

#ifdef __cplusplus
}
#endif
#endif
