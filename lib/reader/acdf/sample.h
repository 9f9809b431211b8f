/* Sampling and evaluating .acdf environments: freestanding headers, valid C99, C++17 and CUDA/HIP/SYCL.
 * acdf/halvings.h has the trees, acdf/grid.h the sphere, acdf/random.h random numbers, acdf/elementary.h the rest.
 *
 * It works on plain views into the bytes of a *checked* file (acdf/reader.h checks once, at load; nothing
 * is checked here). Functions are pure: no allocation, no globals, no errors. To call them in a GPU kernel
 * define ACDF_FN before including, for example `#define ACDF_FN static inline __host__ __device__`.
 *
 * The trade-off: a table as large as the image takes one lookup per axis but misses the cache at every step. An
 * adaptive tree takes a few comparisons and stays in the cache.
 *
 * Frame: right-handed, z up. theta is measured from +z, phi from +x towards +y. Pdfs are per
 * steradian. docs/conventions.md maps this frame to that of other programs. */
#ifndef ACDF_SAMPLE_H
#define ACDF_SAMPLE_H

#include <acdf/curves_interface.h>
#include <acdf/halvings.h>
#include <acdf/partner.h>
#include <acdf/random.h>
#include <acdf/widen.h>

#ifdef __cplusplus
extern "C" {
#endif

/* A pdf over the sphere in a checked file: a tree of halvings, or what `curves` samples. */
typedef struct AcdfEnvironment {
    uint32_t columns;             /* axis 0: position 0 is phi = +pi, `columns` is phi = -pi; or u from 0 to 1 */
    uint32_t rows;                /* axis 1: position 0 is theta = 0 (+z), `rows` is theta = pi; or v from 0 to 1 */
    double total;                 /* integral of the target over the sphere */
    uint32_t parameterization;    /* ACDF_PARAM_OCTAHEDRAL: u and v of the square; all else: phi and theta */
    const AcdfHalvedTree* halved; /* null: curves */
    const AcdfPartner* partner;   /* null: to be used alone */
    const AcdfCurves* curves;     /* null: halvings; else */
    const uint8_t* tree;          /* chunk TREE, */
    uint32_t root;                /* and the curve in it that divides the sphere */
} AcdfEnvironment;

/* The grid that positions lie on. */
ACDF_FN AcdfGrid acdf_environment_grid(const AcdfEnvironment* env) {
    AcdfGrid grid;
    grid.columns = env->columns;
    grid.rows = env->rows;
    grid.parameterization = env->parameterization;
    return grid;
}

/* ---- trees of halvings ------------------------------------------------------------------------------- */

/* The box of a leaf. */
ACDF_INLINE void acdf_halved_ranges(const AcdfSpan box[2], AcdfRange range[2]) {
    int axis;
    for (axis = 0; axis < 2; ++axis) {
        range[axis].low = box[axis].end[0];
        range[axis].high = box[axis].end[1];
    }
}

/* z at the rows of a lat-long grid: acdf_row_z, kept with the tree. */
ACDF_INLINE const double* acdf_halved_heights(const AcdfHalvedTree* tree) {
    return (const double*)(const void*)ACDF_WORDS(tree, tree->heights);
}
ACDF_INLINE double acdf_halved_height(const AcdfHalvedTree* tree, uint32_t row) {
    return acdf_halved_heights(tree)[row];
}

/* acdf_environment_sample by halvings. */
ACDF_INLINE AcdfDirectionSample acdf_environment_halved_sample(const AcdfEnvironment* env, double u0, double u1) {
    const uint32_t resolution[2] = {env->columns, env->rows};
    const double given[2] = {acdf_unit_interval(u0), acdf_unit_interval(u1)};
    const uint32_t number[2] = {acdf_step_of(given[0]), acdf_step_of(given[1])};
    AcdfSpan steps[2], box[2];
    AcdfRange range[2];
    double u[2], p;
    acdf_halved_sample(env->halved, resolution, number, steps, box);
    acdf_halved_ranges(box, range);
    u[0] = acdf_span_fraction(&steps[0], given[0]);
    u[1] = acdf_span_fraction(&steps[1], given[1]);
    p = acdf_span_share(&steps[0]) * acdf_span_share(&steps[1]);
    if (env->parameterization != ACDF_PARAM_OCTAHEDRAL)
        return acdf_sphere_position_between(env->columns, range, u, p,
                                            acdf_halved_height(env->halved, range[1].low),
                                            acdf_halved_height(env->halved, range[1].high));
    {
        const AcdfGrid grid = acdf_environment_grid(env);
        return acdf_octahedral_position(&grid, range, u, p);
    }
}

/* The cell that holds a grid step of each axis, the random numbers that lead there, and its probability. */
ACDF_INLINE double acdf_environment_halved_cell(const AcdfEnvironment* env, const uint32_t square[2],
                                                AcdfSpan steps[2], AcdfRange range[2]) {
    const uint32_t resolution[2] = {env->columns, env->rows};
    AcdfSpan box[2];
    acdf_halved_find(env->halved, resolution, square, steps, box);
    acdf_halved_ranges(box, range);
    return acdf_span_share(&steps[0]) * acdf_span_share(&steps[1]);
}

/* The pdf in a cell of a lat-long or octahedral grid. */
ACDF_INLINE float acdf_halved_pdf(const AcdfEnvironment* env, const AcdfRange range[2], double p) {
    double height;
    if (!(p > 0.0)) return 0.0f;
    if (env->parameterization == ACDF_PARAM_OCTAHEDRAL)
        height = 2.0 * (double)(range[1].high - range[1].low) / (double)env->rows;
    else height = acdf_halved_height(env->halved, range[1].low) - acdf_halved_height(env->halved, range[1].high);
    return acdf_cell_pdf(p, range[0].high - range[0].low, env->columns, height);
}

/* acdf_environment_pdf by halvings, in doubles: right at the borders of cells, too. */
ACDF_OUTLINE float acdf_environment_halved_pdf_at_border(const AcdfEnvironment* env, const float direction[3]) {
    const AcdfGrid grid = acdf_environment_grid(env);
    AcdfSpan steps[2];
    AcdfRange range[2];
    double position[2], p;
    uint32_t square[2];
    if (!acdf_grid_square(&grid, direction, square, position)) return 0.0f;
    p = acdf_environment_halved_cell(env, square, steps, range);
    return acdf_halved_pdf(env, range, p);
}

/* Whether a position in floats surely lies in a box. */
ACDF_INLINE int acdf_is_surely_in(const float position[2], const float error[2], uint32_t low0, uint32_t high0,
                                  uint32_t low1, uint32_t high1) {
    return position[0] - (float)low0 > error[0] && (float)high0 - position[0] > error[0] &&
           position[1] - (float)low1 > error[1] && (float)high1 - position[1] > error[1];
}

/* acdf_environment_pdf by halvings. */
ACDF_INLINE float acdf_environment_halved_pdf(const AcdfEnvironment* env, const float direction[3]) {
    float position[2], error[2];
    AcdfSpan steps[2];
    AcdfRange range[2];
    uint32_t square[2];
    double p;
    if (env->parameterization == ACDF_PARAM_OCTAHEDRAL ||
        !acdf_sphere_nearly(env->columns, env->rows, direction, position, error))
        return acdf_environment_halved_pdf_at_border(env, direction);
    square[0] = (uint32_t)position[0] < env->columns ? (uint32_t)position[0] : env->columns - 1u;
    square[1] = (uint32_t)position[1] < env->rows ? (uint32_t)position[1] : env->rows - 1u;
    if (env->halved->bits) {
        const AcdfStart* start = acdf_halvings_start_at(env->halved, square);
        if (start->node == ACDF_LEAF && acdf_is_surely_in(position, error, start->box[0][0], start->box[0][1],
                                                          start->box[1][0], start->box[1][1]))
            return start->pdf;
    }
    p = acdf_environment_halved_cell(env, square, steps, range);
    return acdf_is_surely_in(position, error, range[0].low, range[0].high, range[1].low, range[1].high)
               ? acdf_halved_pdf(env, range, p)
               : acdf_environment_halved_pdf_at_border(env, direction);
}

/* The cell that holds a square, and the random numbers that lead there. Returns its probability. */
ACDF_INLINE double acdf_environment_halved_find(const AcdfEnvironment* env, const uint32_t square[2],
                                                AcdfRange range[2], AcdfStratum strata[2]) {
    AcdfSpan steps[2];
    const double p = acdf_environment_halved_cell(env, square, steps, range);
    int axis;
    for (axis = 0; axis < 2; ++axis) {
        strata[axis].low = (double)steps[axis].end[0] * 0x1p-31;
        strata[axis].width = acdf_span_share(&steps[axis]);
    }
    return p;
}

/* ---- any ---------------------------------------------------------------------------------------------- */

/* acdf_environment_halved_find of any tree. */
ACDF_INLINE double acdf_environment_find_square(const AcdfEnvironment* env, const uint32_t square[2],
                                                AcdfRange range[2], AcdfStratum strata[2]) {
    ACDF_RETURN_CURVES(env, find(env, square, range, strata));
    return acdf_environment_halved_find(env, square, range, strata);
}

/* Where a direction falls: its cell, the random numbers that lead there, and the fractions t[axis] across the cell
 * in the measures of the axes. Returns the cell's probability; 0 for directions that are NaN or whose length
 * differs from 1 by more than about 5e-4. */
ACDF_FN double acdf_environment_find(const AcdfEnvironment* env, const float direction[3], AcdfRange range[2],
                                     double t[2], AcdfStratum strata[2]) {
    const AcdfGrid grid = acdf_environment_grid(env);
    double position[2], p;
    uint32_t square[2];
    if (!acdf_grid_square(&grid, direction, square, position)) return 0.0;
    p = acdf_environment_find_square(env, square, range, strata);
    acdf_grid_fractions(&grid, direction, position, range, t);
    return p;
}

/* Samples a direction. u0 (phi or u) and u1 (theta or v) in [0, 1]; values outside are clamped, NaN counts as 0.
 * Monotone in each of them within a cell: strata of random numbers stay strata of directions. */
ACDF_INLINE AcdfDirectionSample acdf_environment_sample(const AcdfEnvironment* env, double u0, double u1) {
    ACDF_RETURN_CURVES(env, sample(env, u0, u1));
    return acdf_environment_halved_sample(env, u0, u1);
}

/* The pdf, in sr^-1, with which acdf_environment_sample returns `direction` (unit): exactly the sample's. 0 where
 * no sample falls, and for directions that are NaN or not of unit length. */
ACDF_INLINE float acdf_environment_pdf(const AcdfEnvironment* env, const float direction[3]) {
    ACDF_RETURN_CURVES(env, pdf(env, direction));
    return acdf_environment_halved_pdf(env, direction);
}

/* The random numbers u[2] for which acdf_environment_sample returns `direction`. Returns 1, or 0 (and u unset)
 * where the pdf is 0. */
ACDF_FN int acdf_environment_invert(const AcdfEnvironment* env, const float direction[3], double u[2]) {
    AcdfRange range[2];
    AcdfStratum strata[2];
    double t[2];
    int axis;
    ACDF_RETURN_CURVES(env, invert(env, direction, u));
    if (!(acdf_environment_find(env, direction, range, t, strata) > 0.0)) return 0;
    for (axis = 0; axis < 2; ++axis) u[axis] = acdf_stratum_number(&strata[axis], t[axis]);
    return 1;
}

#ifdef __cplusplus
}
#endif
#endif
