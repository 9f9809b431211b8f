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

#ifdef __cplusplus
extern "C" {
#endif

/* A pdf over the sampled axes for each bin of the indexed ones, in a checked file. */
typedef struct AcdfTable {
    const AcdfHalving* nodes;   /* of the trees of all bins */
    const AcdfBin* bins;        /* row-major over the indexed axes, the last one fastest */
    const AcdfAxis* axes;       /* indexed ones first */
    uint32_t axis_count;        /* of both roles, at most ACDF_MAX_AXES */
    uint32_t indexed_count;     /* less than axis_count */
    double total;               /* sum over the bins of the integral over the sampled axes */
    const AcdfPartner* partner; /* null: to be used alone */
} AcdfTable;

/* Where a point falls, on each sampled axis from 0. */
typedef struct AcdfTablePosition {
    AcdfSpan steps[ACDF_MAX_AXES];  /* of random numbers that lead to the cell */
    AcdfSpan box[ACDF_MAX_AXES];    /* the cell */
    double position[ACDF_MAX_AXES]; /* the point, in [0, resolution] */
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

/* Sampled axis i, from 0. */
ACDF_FN const AcdfAxis* acdf_table_axis(const AcdfTable* table, uint32_t i) {
    return &table->axes[table->indexed_count + i];
}

/* All random numbers and all of each axis, before a tree narrows them. */
ACDF_FN void acdf_table_whole(const AcdfTable* table, AcdfTablePosition* place) {
    const uint32_t count = acdf_table_sampled_count(table);
    uint32_t i;
    for (i = 0; i < count; ++i) {
        place->steps[i].end[0] = place->box[i].end[0] = 0;
        place->steps[i].end[1] = ACDF_STEPS;
        place->box[i].end[1] = acdf_table_axis(table, i)->resolution;
    }
}

/* The probability of a cell. */
ACDF_FN double acdf_table_probability(const AcdfTable* table, const AcdfTablePosition* place) {
    const uint32_t count = acdf_table_sampled_count(table);
    double p = 1.0;
    uint32_t i;
    for (i = 0; i < count; ++i) p *= acdf_span_share(&place->steps[i]);
    return p;
}

/* The pdf in a cell of probability p. Both acdf_table_sample and acdf_table_pdf return the same value, bit for bit,
 * because both call it with the same cell. */
ACDF_FN double acdf_table_cell_pdf(const AcdfTable* table, double p, const AcdfTablePosition* place) {
    const uint32_t count = acdf_table_sampled_count(table);
    uint32_t i;
    for (i = 0; i < count; ++i) {
        const AcdfAxis* a = acdf_table_axis(table, i);
        const AcdfSpan* box = &place->box[i];
        p *= (double)a->resolution / (fabs(a->high - a->low) * (double)(box->end[1] - box->end[0]));
    }
    return acdf_clamp(p, ACDF_DOUBLE_MIN, ACDF_DOUBLE_MAX);
}

/* Samples a point. index[indexed_count] as in acdf_table_bin; u[sampled count] in [0, 1], clamped, NaN counts as 0.
 * Fills x[sampled count], monotone in each u within a cell, and returns the pdf there, finite and > 0.
 * Returns 0, and leaves x as it is, where there is nothing to sample. */
ACDF_FN double acdf_table_sample(const AcdfTable* table, const uint32_t* index, const double* u, double* x) {
    const AcdfBin* bin = acdf_table_bin(table, index);
    const uint32_t count = acdf_table_sampled_count(table);
    AcdfTablePosition place;
    double number[ACDF_MAX_AXES];
    uint32_t step[ACDF_MAX_AXES], i;
    if (!bin) return 0.0;
    for (i = 0; i < count; ++i) {
        number[i] = acdf_unit_interval(u[i]);
        step[i] = acdf_step_of(number[i]);
    }
    acdf_table_whole(table, &place);
    acdf_halvings_sample(table->nodes, bin->root, step, place.steps, place.box);
    for (i = 0; i < count; ++i) {
        const AcdfAxis* a = acdf_table_axis(table, i);
        const double low = (double)place.box[i].end[0], high = (double)place.box[i].end[1];
        const double border = acdf_table_border(a);
        const double position = low + acdf_span_fraction(&place.steps[i], number[i]) * (high - low);
        x[i] = acdf_table_coordinate(a, acdf_clamp(position, low + border, high - border));
    }
    return acdf_table_cell_pdf(table, acdf_table_probability(table, &place), &place);
}

/* Finds the cell that holds x[sampled count]. Returns its probability; 0 where no sample falls, for NaN and outside
 * the axes' ranges. A border belongs to the cell of the higher position, the end of an axis to its last cell. */
ACDF_FN double acdf_table_find(const AcdfTable* table, const uint32_t* index, const double* x,
                               AcdfTablePosition* place) {
    const AcdfBin* bin = acdf_table_bin(table, index);
    const uint32_t count = acdf_table_sampled_count(table);
    uint32_t step[ACDF_MAX_AXES], i;
    if (!bin) return 0.0;
    for (i = 0; i < count; ++i) {
        const AcdfAxis* a = acdf_table_axis(table, i);
        if (!acdf_table_in_range(a, x[i])) return 0.0;
        place->position[i] = acdf_table_position(a, x[i]);
        step[i] = (uint32_t)place->position[i];
        if (step[i] >= a->resolution) step[i] = a->resolution - 1;
    }
    acdf_table_whole(table, place);
    acdf_halvings_find(table->nodes, bin->root, step, place->steps, place->box);
    return acdf_table_probability(table, place);
}

/* The pdf with which acdf_table_sample samples x in the bin of `index`; 0 where no sample falls. */
ACDF_FN double acdf_table_pdf(const AcdfTable* table, const uint32_t* index, const double* x) {
    AcdfTablePosition place;
    const double p = acdf_table_find(table, index, x, &place);
    return p > 0.0 ? acdf_table_cell_pdf(table, p, &place) : 0.0;
}

/* The random numbers u[sampled count] for which acdf_table_sample returns x. Returns 1, or 0 (and u unset) where
 * the pdf is 0. */
ACDF_FN int acdf_table_invert(const AcdfTable* table, const uint32_t* index, const double* x, double* u) {
    const uint32_t count = acdf_table_sampled_count(table);
    AcdfTablePosition place;
    uint32_t i;
    if (!(acdf_table_find(table, index, x, &place) > 0.0)) return 0;
    for (i = 0; i < count; ++i) {
        const double low = (double)place.box[i].end[0], high = (double)place.box[i].end[1];
        const double t = acdf_clamp((place.position[i] - low) / (high - low), 0.0, 1.0);
        u[i] = (double)place.steps[i].end[0] * 0x1p-31 + acdf_span_share(&place.steps[i]) * t;
    }
    return 1;
}

#ifdef __cplusplus
}
#endif
#endif
