/* Trees of halvings (SPEC.md §6.2): the cell that random numbers lead to, and the cell that holds a position.
 * Valid C99, C++17 and CUDA/HIP/SYCL; no allocation, no errors: a tree was checked when its file was opened.
 *
 * A node is a box of grid steps. One that is not a leaf is halved on one axis, at (low + high) / 2 rounded down, so
 * that files store no borders. The random numbers of an axis are counted in steps of 2^-31: a node is reached by
 * the steps [low, high) of each axis, and a halving divides those of its own axis between the two halves. All of
 * that is integers. Every machine finds the same cell, and the probability of a cell is exactly the product of its
 * shares of all steps. */
#ifndef ACDF_HALVINGS_H
#define ACDF_HALVINGS_H

#include <acdf/elementary.h>

#ifdef __cplusplus
extern "C" {
#endif

#define ACDF_STEPS 0x80000000u /* of the random numbers of an axis */

/* A node that is halved. The lower half, where it is not a leaf, is the next node. */
typedef struct AcdfHalving {
    uint32_t threshold; /* the first step of random numbers that leads to the upper half; at most ACDF_STEPS */
    uint32_t link; /* bits 0 to 2: axis; bits 3 and 4: whether the lower and the upper half are leaves; bits 5 to
                      31: the number of nodes from here to the upper half, if that is not a leaf */
} AcdfHalving;

#define ACDF_LEAF 0xFFFFFFFFu /* instead of the number of a node: a leaf, which has none */

/* [low, high): steps of a grid's axis or of an axis of random numbers. */
typedef struct AcdfSpan {
    uint32_t end[2]; /* low, high */
} AcdfSpan;

/* A node of two axes, and how random numbers reach it: where a descent begins. */
typedef struct AcdfStart {
    uint32_t node; /* or ACDF_LEAF */
    float pdf;     /* of a leaf of an environment, sr^-1; else 0 */
    AcdfSpan steps[2];
    uint16_t box[2][2];
} AcdfStart;

/* A tree of halvings as it is made when a file is opened: flat words without pointers, offsets in words from the
 * start of this struct. */
typedef struct AcdfHalvedTree {
    uint32_t words; /* of all */
    uint32_t count; /* nodes that are halved */
    uint32_t nodes; /* AcdfHalving[count] */
    /* The lookup grid: squares of 2^-bits of each axis, in rows of axis 0, each with the number of the deepest node
     * that holds it. Made for trees of two axes, unless a file is opened without. */
    uint32_t bits;              /* 0: there is none */
    uint32_t numbers;           /* uint16: by random numbers */
    uint32_t positions;         /* uint16: by positions */
    uint32_t starts;            /* AcdfStart */
    uint32_t position_scale[2]; /* step * scale / 2^32 is the square of a grid step */
    uint32_t heights;           /* double[rows + 1]: acdf_row_z, or acdf_half_row of BRDFs; 0: there are none */
} AcdfHalvedTree;

/* The array that begins at a word of a tree, and its nodes. */
#define ACDF_WORDS(tree, offset) ((const uint32_t*)(const void*)(tree) + (offset))
ACDF_INLINE const AcdfHalving* acdf_halvings_nodes(const AcdfHalvedTree* tree) {
    return (const AcdfHalving*)(const void*)ACDF_WORDS(tree, tree->nodes);
}

/* The share of the lower half that a code stands for, in steps of 2^-31. Codes are spaced so that what rounding to
 * them costs, (change of p)^2 / (p (1 - p)), is nearly the same for all; the first and the last stand for 0 and 1.
 */
ACDF_FN uint32_t acdf_halving_share(uint32_t code, uint32_t code_bits) {
    const double q = (double)((1u << code_bits) - 1u), j = 2.0 * (double)code - q;
    const double even = 14.0 * q * q * q, odd = j * (11.0 * q * q + 3.0 * j * j);
    const double lower = even + odd, upper = even - odd;
    return (uint32_t)(lower * lower / (lower * lower + upper * upper) * 2147483648.0 + 0.5);
}

/* The first step of random numbers of a node that leads to its upper half: `share` is acdf_halving_share(code). The
 * first code leads none to the lower half, the last none to the upper; others lead at least one step to each, so
 * that the node must have two or more. */
ACDF_FN uint32_t acdf_halving_threshold(const AcdfSpan* steps, uint32_t code, uint32_t code_bits, uint32_t share) {
    const uint32_t low = steps->end[0], wide = steps->end[1] - low;
    uint32_t lower;
    if (code == 0) return low;
    if (code == (1u << code_bits) - 1u) return steps->end[1];
    lower = (uint32_t)((uint64_t)wide * share >> 31);
    if (lower == 0) lower = 1;
    if (lower >= wide) lower = wide - 1;
    return low + lower;
}

/* Where a node is halved. */
ACDF_INLINE uint32_t acdf_span_middle(const AcdfSpan* box) { return (box->end[0] + box->end[1]) >> 1; }

/* Descends from a node to the leaf that steps u[axis] of random numbers lead to; narrows `steps` and `box` of each
 * axis, which are those of the node, to those of the leaf. Axes have fewer than 2^31 steps. */
ACDF_INLINE void acdf_halvings_sample(const AcdfHalving* nodes, uint32_t at, const uint32_t* u, AcdfSpan* steps,
                                      AcdfSpan* box) {
    while (at != ACDF_LEAF) {
        const AcdfHalving node = nodes[at];
        const uint32_t axis = node.link & 7u, upper = u[axis] >= node.threshold;
        box[axis].end[1u - upper] = acdf_span_middle(&box[axis]);
        steps[axis].end[1u - upper] = node.threshold;
        if (node.link >> (3u + upper) & 1u) break;
        at += upper ? node.link >> 5 : 1u;
    }
}

/* Descends from a node to the leaf that holds the grid steps at[axis]; otherwise as acdf_halvings_sample. */
ACDF_INLINE void acdf_halvings_find(const AcdfHalving* nodes, uint32_t at, const uint32_t* position,
                                    AcdfSpan* steps, AcdfSpan* box) {
    while (at != ACDF_LEAF) {
        const AcdfHalving node = nodes[at];
        const uint32_t axis = node.link & 7u, middle = acdf_span_middle(&box[axis]);
        const uint32_t upper = position[axis] >= middle;
        box[axis].end[1u - upper] = middle;
        steps[axis].end[1u - upper] = node.threshold;
        if (node.link >> (3u + upper) & 1u) break;
        at += upper ? node.link >> 5 : 1u;
    }
}

/* The root of a tree: all random numbers and all `resolution` steps of each of `axes` axes. Returns its number. */
ACDF_INLINE uint32_t acdf_halvings_root(const AcdfHalvedTree* tree, const uint32_t* resolution, uint32_t axes,
                                        AcdfSpan* steps, AcdfSpan* box) {
    uint32_t axis;
    for (axis = 0; axis < axes; ++axis) {
        steps[axis].end[0] = box[axis].end[0] = 0;
        steps[axis].end[1] = ACDF_STEPS;
        box[axis].end[1] = resolution[axis];
    }
    return tree->count ? 0 : ACDF_LEAF;
}

/* Where a descent begins by square (x, y) of a lookup grid at `grid`. */
ACDF_INLINE const AcdfStart* acdf_halvings_start(const AcdfHalvedTree* tree, uint32_t grid, uint32_t x,
                                                 uint32_t y) {
    const uint16_t* squares = (const uint16_t*)(const void*)ACDF_WORDS(tree, grid);
    return (const AcdfStart*)(const void*)ACDF_WORDS(tree, tree->starts) + squares[(size_t)y << tree->bits | x];
}
ACDF_INLINE const AcdfStart* acdf_halvings_start_at(const AcdfHalvedTree* tree, const uint32_t position[2]) {
    return acdf_halvings_start(tree, tree->positions,
                               (uint32_t)((uint64_t)position[0] * tree->position_scale[0] >> 32),
                               (uint32_t)((uint64_t)position[1] * tree->position_scale[1] >> 32));
}

/* Begins a descent. Returns the number of the node. */
ACDF_INLINE uint32_t acdf_halvings_begin(const AcdfStart* start, AcdfSpan steps[2], AcdfSpan box[2]) {
    int axis;
    for (axis = 0; axis < 2; ++axis) {
        steps[axis] = start->steps[axis];
        box[axis].end[0] = start->box[axis][0];
        box[axis].end[1] = start->box[axis][1];
    }
    return start->node;
}

/* The cell of a tree of two axes that steps u[2] of random numbers lead to. */
ACDF_INLINE void acdf_halved_sample(const AcdfHalvedTree* tree, const uint32_t resolution[2], const uint32_t u[2],
                                    AcdfSpan steps[2], AcdfSpan box[2]) {
    const uint32_t shift = 31u - tree->bits;
    const uint32_t at =
        tree->bits ? acdf_halvings_begin(acdf_halvings_start(tree, tree->numbers, u[0] >> shift, u[1] >> shift),
                                         steps, box)
                   : acdf_halvings_root(tree, resolution, 2, steps, box);
    acdf_halvings_sample(acdf_halvings_nodes(tree), at, u, steps, box);
}

/* The cell of a tree of two axes that holds the grid steps position[2]. */
ACDF_INLINE void acdf_halved_find(const AcdfHalvedTree* tree, const uint32_t resolution[2],
                                  const uint32_t position[2], AcdfSpan steps[2], AcdfSpan box[2]) {
    const uint32_t at = tree->bits ? acdf_halvings_begin(acdf_halvings_start_at(tree, position), steps, box)
                                   : acdf_halvings_root(tree, resolution, 2, steps, box);
    acdf_halvings_find(acdf_halvings_nodes(tree), at, position, steps, box);
}

/* A number in [0, 1] in steps: at most the last one. */
ACDF_INLINE uint32_t acdf_step_of(double u) {
    const uint32_t step = (uint32_t)(u * 2147483648.0);
    return step < ACDF_STEPS ? step : ACDF_STEPS - 1u;
}

/* How far across a cell a number in [0, 1] lies that leads to it. */
ACDF_INLINE double acdf_span_fraction(const AcdfSpan* steps, double u) {
    const double t = (u * 2147483648.0 - (double)steps->end[0]) / (double)(steps->end[1] - steps->end[0]);
    return t < 1.0 ? t : 1.0;
}

/* The share of all steps that a span has, exactly. */
ACDF_INLINE double acdf_span_share(const AcdfSpan* steps) {
    return (double)(steps->end[1] - steps->end[0]) * 0x1p-31;
}

#ifdef __cplusplus
}
#endif
#endif
