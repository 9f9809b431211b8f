/* Sampling and evaluating .acdf tables of any number of axes. One freestanding header over acdf/sample.h, valid
 * C99, C++17 and CUDA/HIP/SYCL, with the same contract: plain views into a checked file, no allocation, no errors.
 *
 * The first `indexed_count` axes are chosen by the caller: one index each, in [0, resolution), which together name
 * a bin. The others are sampled: a point x with one coordinate a sampled axis, in the units of the axis. Pdfs
 * are per product of those units, and integrate to 1 within each bin that has any energy.
 *
 * Coordinates are double because an axis may have more steps than a float has values. A sample keeps clear of its
 * cell's borders, so that acdf_table_pdf finds the same cell: it returns the very same pdf. */
#ifndef ACDF_TABLE_H
#define ACDF_TABLE_H

#include <acdf/sample.h>
#include <acdf/table_entries.h>

#ifdef __cplusplus
extern "C" {
#endif

/* A pdf over the sampled axes for each bin of the indexed ones, in a checked file. */
typedef struct AcdfTable {
    const uint8_t* tree;        /* chunk TREE */
    const AcdfBin* bins;        /* row-major over the indexed axes, the last one fastest */
    const AcdfAxis* axes;       /* indexed ones first */
    uint32_t axis_count;        /* of both roles, at most ACDF_MAX_AXES */
    uint32_t indexed_count;     /* less than axis_count */
    double total;               /* sum over the bins of the integral over the sampled axes */
    const AcdfPartner* partner; /* null: to be used alone */
    uint32_t tree_units;        /* of two bytes, that the tree has; 0: not known */
    const AcdfEntries* entries; /* runtime tables; null: each call searches trees from their roots */
} AcdfTable;

/* Where a point falls. */
typedef struct AcdfTablePosition {
    AcdfRange range[ACDF_MAX_AXES]; /* the cell, on each axis */
    double position[ACDF_MAX_AXES]; /* the point, in [0, resolution] on each sampled axis */
} AcdfTablePosition;

#define ACDF_DOUBLE_MIN 2.2250738585072014e-308
#define ACDF_DOUBLE_MAX 1.7976931348623157e308

/* How many axes are sampled: numbers of `u` and `x`. */
ACDF_FN uint32_t acdf_table_sampled_count(const AcdfTable* table) {
    return table->axis_count - table->indexed_count;
}

/* The bin of index[indexed_count] (null where no axis is indexed); null where an index is out of range or the bin
 * has no energy: nothing can be sampled there. */
ACDF_FN const AcdfBin* acdf_table_bin(const AcdfTable* table, const uint32_t* index) {
    size_t bin = 0;
    uint32_t axis;
    for (axis = 0; axis < table->indexed_count; ++axis) {
        if (index[axis] >= table->axes[axis].resolution) return 0;
        bin = bin * table->axes[axis].resolution + index[axis];
    }
    return table->bins[bin].share > 0.0f ? &table->bins[bin] : 0;
}

/* Whether double coordinates resolve the axis's steps (SPEC.md rule 9004). */
ACDF_FN int acdf_table_axis_steps(const AcdfAxis* axis) {
    const double low = fabs(axis->low), high = fabs(axis->high), largest = low > high ? low : high;
    const double step = fabs(axis->high - axis->low) / (double)axis->resolution;
    return largest <= 0x1p100 && step >= 0x1p-100 && step >= 0x1p-40 * largest;
}

/* Where on an axis a coordinate lies, in steps from its low end, and back. */
ACDF_FN double acdf_table_position(const AcdfAxis* axis, double x) {
    return (x - axis->low) / (axis->high - axis->low) * (double)axis->resolution;
}
ACDF_FN double acdf_table_coordinate(const AcdfAxis* axis, double position) {
    return axis->low + (axis->high - axis->low) * (position / (double)axis->resolution);
}

/* Whether a coordinate is in the closed range of the axis; then its position is in [0, resolution]. A coordinate a
 * little outside would have the position of the end by rounding. */
ACDF_FN int acdf_table_in_range(const AcdfAxis* axis, double x) {
    const int rises = axis->low < axis->high;
    return acdf_is_finite(x) && x >= (rises ? axis->low : axis->high) && x <= (rises ? axis->high : axis->low);
}

/* How far a sample stays from its cell's borders, in steps: above the rounding error of acdf_table_position at
 * acdf_table_coordinate, and below 2^-8 (SPEC.md rule 9004). */
ACDF_FN double acdf_table_border(const AcdfAxis* axis) {
    const double low = fabs(axis->low), high = fabs(axis->high);
    return 0x1p-48 * (low > high ? low : high) * (double)axis->resolution / fabs(axis->high - axis->low);
}

/* Fraction across the cell, of a position in it. */
ACDF_FN double acdf_table_fraction(const AcdfRange* range, double position) {
    return acdf_clamp((position - (double)range->low) / (double)(range->high - range->low), 0.0, 1.0);
}

/* All of each axis, before a tree narrows it: range[axis_count]. */
ACDF_FN void acdf_table_whole(const AcdfTable* table, AcdfRange* range) {
    uint32_t axis;
    for (axis = 0; axis < table->axis_count; ++axis) {
        range[axis].low = 0;
        range[axis].high = table->axes[axis].resolution;
        range[axis].tilt = 0.0;
    }
}

/* The pdf of a position in a cell of probability p. Both acdf_table_sample and acdf_table_pdf return the same
 * value, bit for bit, because both call it with the same cell and the same position. */
ACDF_FN double acdf_table_cell_pdf(const AcdfTable* table, double p, const AcdfTablePosition* place) {
    uint32_t axis;
    for (axis = table->indexed_count; axis < table->axis_count; ++axis) {
        const AcdfAxis* a = &table->axes[axis];
        const AcdfRange* range = &place->range[axis];
        p *= (double)a->resolution / (fabs(a->high - a->low) * (double)(range->high - range->low));
        if (range->tilt != 0.0) p *= acdf_tilt_pdf(range->tilt, acdf_table_fraction(range, place->position[axis]));
    }
    return acdf_clamp(p, ACDF_DOUBLE_MIN, ACDF_DOUBLE_MAX);
}

/* The grids of a bin; null where its tree is searched from the root. */
ACDF_INLINE const AcdfEntryBin* acdf_table_entries(const AcdfTable* table, const AcdfBin* bin) {
    const AcdfEntryBin* entries;
    if (!table->entries) return 0;
    entries = acdf_entry_bin(table->entries, (size_t)(bin - table->bins));
    return entries->positions ? entries : 0;
}

/* acdf_table_sample by the grids of a bin, which has no tilts: where in the cell a point lies is not asked again.
 */
ACDF_INLINE double acdf_table_entry_sample(const AcdfTable* table, const AcdfEntryBin* grids, const double* u,
                                           double* x) {
    const uint32_t first = table->indexed_count, count = table->axis_count - first;
    const AcdfEntryCurve* curve;
    double left[ACDF_MAX_AXES], p;
    AcdfTablePosition place;
    uint32_t axis;
    for (axis = first; axis < table->axis_count; ++axis) left[axis] = acdf_unit_interval(u[axis - first]);
    curve = acdf_entry_of_numbers(table->entries, grids, count, left + first);
    acdf_entry_ranges(curve, count, place.range + first);
    p = acdf_short_tree_sample_on(table->tree, table->tree_units, curve->at, left, place.range, curve->probability);
    for (axis = first; axis < table->axis_count; ++axis) {
        const double low = (double)place.range[axis].low, high = (double)place.range[axis].high;
        const double border = grids->axes[axis - first].border, position = low + left[axis] * (high - low);
        x[axis - first] =
            acdf_table_coordinate(&table->axes[axis], acdf_clamp(position, low + border, high - border));
    }
    return acdf_table_cell_pdf(table, p, &place);
}

/* Samples a point. index[indexed_count] as in acdf_table_bin; u[sampled count] in [0, 1], clamped, NaN counts as 0.
 * Fills x[sampled count], monotone in each u within a segment, and returns the pdf there, finite and > 0.
 * Returns 0, and leaves x as it is, where there is nothing to sample. */
ACDF_FN double acdf_table_sample(const AcdfTable* table, const uint32_t* index, const double* u, double* x) {
    const AcdfBin* bin = acdf_table_bin(table, index);
    const uint32_t first = table->indexed_count;
    const AcdfEntryBin* grids;
    AcdfTablePosition place;
    double left[ACDF_MAX_AXES];
    double p;
    uint32_t axis;
    if (!bin) return 0.0;
    grids = acdf_table_entries(table, bin);
    if (grids) return acdf_table_entry_sample(table, grids, u, x);
    for (axis = first; axis < table->axis_count; ++axis) left[axis] = acdf_unit_interval(u[axis - first]);
    acdf_table_whole(table, place.range);
    p = acdf_tree_sample(table->tree, bin->root, left, place.range);
    for (axis = first; axis < table->axis_count; ++axis) {
        const AcdfAxis* a = &table->axes[axis];
        const AcdfRange* range = &place.range[axis];
        const double border = acdf_table_border(a);
        const double t = acdf_tilt_sample(range->tilt, left[axis]);
        const double position = (double)range->low + t * (double)(range->high - range->low);
        x[axis - first] = acdf_table_coordinate(
            a, acdf_clamp(position, (double)range->low + border, (double)range->high - border));
        place.position[axis] = acdf_table_position(a, x[axis - first]);
    }
    return acdf_table_cell_pdf(table, p, &place);
}

/* Where x[sampled count] lies: its position, and the step of the grid on each sampled axis. Returns 0 for NaN and
 * outside the axes' ranges. */
ACDF_INLINE int acdf_table_step(const AcdfTable* table, const double* x, double* position, uint32_t* step) {
    const uint32_t first = table->indexed_count;
    uint32_t axis;
    for (axis = first; axis < table->axis_count; ++axis) {
        const AcdfAxis* a = &table->axes[axis];
        if (!acdf_table_in_range(a, x[axis - first])) return 0;
        position[axis] = acdf_table_position(a, x[axis - first]);
        step[axis] = (uint32_t)position[axis];
        if (step[axis] >= a->resolution) step[axis] = a->resolution - 1;
    }
    return 1;
}

/* Finds the cell that holds x[sampled count]; `strata` as in acdf_tree_find. Returns its probability; 0 where no
 * sample can fall, for NaN and outside the axes' ranges. A border belongs to the cell of the higher position, the
 * end of an axis to its last cell. */
ACDF_FN double acdf_table_find(const AcdfTable* table, const uint32_t* index, const double* x,
                               AcdfTablePosition* place, AcdfStratum* strata) {
    const AcdfBin* bin = acdf_table_bin(table, index);
    uint32_t step[ACDF_MAX_AXES];
    if (!bin || !acdf_table_step(table, x, place->position, step)) return 0.0;
    acdf_table_whole(table, place->range);
    return acdf_tree_find(table->tree, bin->root, step, place->range, strata);
}

/* acdf_table_pdf by the grids of a bin, which has no tilts. */
ACDF_INLINE double acdf_table_entry_pdf(const AcdfTable* table, const AcdfEntryBin* grids, const double* x) {
    const uint32_t first = table->indexed_count, count = table->axis_count - first;
    const AcdfEntryCurve* curve;
    uint32_t step[ACDF_MAX_AXES], entry;
    AcdfTablePosition place;
    double p;
    if (!acdf_table_step(table, x, place.position, step)) return 0.0;
    entry = acdf_entry_of_position(table->entries, grids, count, step + first);
    if (entry & ACDF_ENTRY_CELL)
        return ((const double*)(const void*)acdf_entry_words(table->entries,
                                                             table->entries->densities))[entry & ~ACDF_ENTRY_CELL];
    curve = acdf_entry_curve(table->entries, entry);
    acdf_entry_ranges(curve, count, place.range + first);
    p = acdf_tree_locate_on(table->tree, table->tree_units, curve->at, step, place.range, curve->probability);
    return p > 0.0 ? acdf_table_cell_pdf(table, p, &place) : 0.0;
}

/* The pdf with which acdf_table_sample samples x in the bin of `index`; 0 where no sample falls. */
ACDF_FN double acdf_table_pdf(const AcdfTable* table, const uint32_t* index, const double* x) {
    const AcdfBin* bin = acdf_table_bin(table, index);
    const AcdfEntryBin* grids = bin ? acdf_table_entries(table, bin) : 0;
    AcdfTablePosition place;
    double p;
    if (grids) return acdf_table_entry_pdf(table, grids, x);
    p = acdf_table_find(table, index, x, &place, 0);
    return p > 0.0 ? acdf_table_cell_pdf(table, p, &place) : 0.0;
}

/* The random numbers u[sampled count] for which acdf_table_sample returns x. Returns 1, or 0 (and u unset) where
 * the pdf is 0. */
ACDF_FN int acdf_table_invert(const AcdfTable* table, const uint32_t* index, const double* x, double* u) {
    AcdfTablePosition place;
    AcdfStratum strata[ACDF_MAX_AXES];
    uint32_t axis;
    for (axis = 0; axis < table->axis_count; ++axis) {
        strata[axis].low = 0.0;
        strata[axis].width = 1.0;
    }
    if (!(acdf_table_find(table, index, x, &place, strata) > 0.0)) return 0;
    for (axis = table->indexed_count; axis < table->axis_count; ++axis) {
        const AcdfRange* range = &place.range[axis];
        const double t = acdf_table_fraction(range, place.position[axis]);
        u[axis - table->indexed_count] = acdf_stratum_number(&strata[axis], range, t);
    }
    return 1;
}

#ifdef __cplusplus
}
#endif
#endif
