/* Runtime tables of table files (acdf/table.h): which cell holds a point, or deep down in which curve of its bin's
 * tree a point or random numbers lie. From there the tree is traversed: samples and pdfs are those of the traversal
 * to the bit. Made once at load (acdf/reader.h); flat words without pointers, which a GPU takes as they lie.
 *
 * Each bin has a grid over the positions of its sampled axes and one over their random numbers. An entry of the
 * first is a cell that holds all of it, or the deepest curve that does; of the other one always a curve. What a
 * curve knows of the way to it stands in its record: the probability, the ranges, and what becomes of random
 * numbers. */
#ifndef ACDF_TABLE_ENTRIES_H
#define ACDF_TABLE_ENTRIES_H

#include <acdf/short_curves.h>

#ifdef __cplusplus
extern "C" {
#endif

#define ACDF_ENTRY_CELL 0x80000000u /* an entry is a cell, not a curve */

/* What a curve on the way makes of the random number of its axis: u becomes (u maximum - low) / width. */
typedef struct AcdfEntryStep {
    uint16_t maximum, low, width, axis;
} AcdfEntryStep;

/* A curve that entries lead to. Its lower and upper positions of each sampled axis follow, two words an axis. */
typedef struct AcdfEntryCurve {
    double probability;    /* of what it divides */
    uint32_t at;           /* in the tree */
    uint32_t first, count; /* of its AcdfEntrySteps, in their order; where numbers lead to it */
    uint32_t reserved;
} AcdfEntryCurve;

/* An axis of the grids of a bin. */
typedef struct AcdfEntryAxis {
    double border;                   /* acdf_table_border */
    uint32_t shift, position_stride; /* bits of positions that are finer than entries; entries to the next one */
    uint32_t number_steps;           /* entries along random numbers: a power of two */
    uint32_t number_stride;
} AcdfEntryAxis;

/* Offsets in words from the start of AcdfEntries. */
typedef struct AcdfEntryBin {
    uint32_t positions, numbers;       /* u32 each; 0: the tree is traversed from its root */
    AcdfEntryAxis axes[ACDF_MAX_AXES]; /* of the sampled ones, from 0 */
} AcdfEntryBin;

/* Offsets in words from the start of this struct, which the arrays follow. */
typedef struct AcdfEntries {
    uint32_t words;       /* of all */
    uint32_t bins;        /* AcdfEntryBin, one a bin */
    uint32_t curves;      /* AcdfEntryCurve */
    uint32_t curve_words; /* from one to the next */
    uint32_t steps;       /* AcdfEntryStep */
    uint32_t densities;   /* f64: of each cell, as acdf_table_cell_pdf returns it */
    uint32_t reserved[10];
} AcdfEntries;
ACDF_STATIC_ASSERT(sizeof(AcdfEntries) % 64 == 0); /* arrays are aligned */

ACDF_INLINE const uint32_t* acdf_entry_words(const AcdfEntries* entries, uint32_t at) {
    return (const uint32_t*)(const void*)entries + at;
}
ACDF_INLINE const AcdfEntryBin* acdf_entry_bin(const AcdfEntries* entries, size_t bin) {
    return (const AcdfEntryBin*)(const void*)acdf_entry_words(entries, entries->bins) + bin;
}
ACDF_INLINE const AcdfEntryCurve* acdf_entry_curve(const AcdfEntries* entries, uint32_t number) {
    return (const AcdfEntryCurve*)(const void*)(acdf_entry_words(entries, entries->curves) +
                                                (size_t)number * entries->curve_words);
}

/* The ranges of what a curve divides, of `count` sampled axes. */
ACDF_INLINE void acdf_entry_ranges(const AcdfEntryCurve* curve, uint32_t count, AcdfRange* range) {
    const uint32_t* ends = (const uint32_t*)(const void*)(curve + 1);
    uint32_t axis;
    for (axis = 0; axis < count; ++axis) {
        range[axis].low = ends[2 * axis];
        range[axis].high = ends[2 * axis + 1];
        range[axis].tilt = 0.0;
    }
}

/* The entry of a square of the grid of positions, of `count` sampled axes. */
ACDF_INLINE uint32_t acdf_entry_of_position(const AcdfEntries* entries, const AcdfEntryBin* bin, uint32_t count,
                                            const uint32_t* square) {
    size_t at = bin->positions;
    uint32_t axis;
    for (axis = 0; axis < count; ++axis)
        at += (size_t)(square[axis] >> bin->axes[axis].shift) * bin->axes[axis].position_stride;
    return ((const uint32_t*)(const void*)entries)[at];
}

/* The curve that random numbers in [0, 1] lead to, of `count` sampled axes, of which it takes its part: u becomes
 * what is left of them, as acdf_tree_sample leaves it there. */
ACDF_INLINE const AcdfEntryCurve* acdf_entry_of_numbers(const AcdfEntries* entries, const AcdfEntryBin* bin,
                                                        uint32_t count, double* u) {
    const AcdfEntryCurve* curve;
    const AcdfEntryStep* step;
    size_t at = bin->numbers;
    uint32_t axis, i;
    for (axis = 0; axis < count; ++axis) {
        const AcdfEntryAxis* a = &bin->axes[axis];
        const uint32_t entry = (uint32_t)(int32_t)(u[axis] * (double)(int32_t)a->number_steps);
        at += (size_t)(entry < a->number_steps ? entry : a->number_steps - 1) * a->number_stride;
    }
    curve = acdf_entry_curve(entries, ((const uint32_t*)(const void*)entries)[at]);
    step = (const AcdfEntryStep*)(const void*)acdf_entry_words(entries, entries->steps) + curve->first;
    for (i = 0; i < curve->count; ++i, ++step) {
        const double maximum = (double)(int32_t)step->maximum;
        double scaled = u[step->axis] * maximum;
        if (scaled >= maximum) scaled = maximum * (1.0 - 0x1p-53);
        u[step->axis] = (scaled - (double)(int32_t)step->low) / (double)(int32_t)step->width;
    }
    return curve;
}

#ifdef __cplusplus
}
#endif
#endif
