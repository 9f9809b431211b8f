/* Sampling and evaluating .acdf environments: freestanding headers, valid C99, C++17 and CUDA/HIP/SYCL.
 * acdf/tree.h has the trees, acdf/grid.h the sphere, acdf/random.h random numbers, acdf/elementary.h the rest.
 *
 * It works on plain views into the bytes of a *checked* file (acdf/reader.h checks once, at load; nothing
 * is checked here). Functions are pure: no allocation, no globals, no errors. To call them in a GPU kernel
 * define ACDF_FN before including, for example `#define ACDF_FN static inline __host__ __device__`.
 *
 * The trade-off: a table of N cells as large as the image is sampled in one lookup per axis but misses the
 * cache at every step; an adaptive tree needs a few more comparisons and stays in the cache. Arithmetic is
 * double because a random number is rescaled once a curve: in float it would run out of bits.
 *
 * Frame: right-handed, z up. theta is measured from +z, phi from +x towards +y. Densities are per
 * steradian. docs/conventions.md maps this frame to that of other programs. */
#ifndef ACDF_SAMPLE_H
#define ACDF_SAMPLE_H

#include <acdf/cells.h>
#include <acdf/company.h>
#include <acdf/grid.h>
#include <acdf/groups.h>
#include <acdf/random.h>
#include <acdf/short_curves.h>

#ifdef __cplusplus
extern "C" {
#endif

/* A density over the sphere in a checked file, and tables of it. */
typedef struct AcdfEnvironment {
    const uint8_t* tree; /* chunk TREE */
    uint32_t root;
    uint32_t columns;           /* axis 0: position 0 is phi = +pi, `columns` is phi = -pi; or u from 0 to 1 */
    uint32_t rows;              /* axis 1: position 0 is theta = 0 (+z), `rows` is theta = pi; or v from 0 to 1 */
    double total;               /* integral of the target over the sphere */
    uint32_t parameterization;  /* ACDF_PARAM_OCTAHEDRAL: u and v of the square; all else: phi and theta */
    const AcdfCells* cells;     /* runtime tables; null: the tree is walked */
    const AcdfCompany* company; /* null: to be used alone */
    uint32_t tree_units;        /* of two bytes, that the tree has; 0: not known */
    const AcdfGroups* groups;   /* runtime tables where `cells` would be too large; null: there are none */
} AcdfEnvironment;

/* The grid that positions lie on. */
ACDF_FN AcdfGrid acdf_environment_grid(const AcdfEnvironment* env) {
    AcdfGrid grid;
    grid.columns = env->columns;
    grid.rows = env->rows;
    grid.parameterization = env->parameterization;
    return grid;
}

/* acdf_environment_sample by the tree alone. */
ACDF_OUTLINE AcdfDirectionSample acdf_environment_walk_sample(const AcdfEnvironment* env, double u0, double u1) {
    const AcdfGrid grid = acdf_environment_grid(env);
    double u[2], p;
    AcdfRange range[2];
    u[0] = acdf_unit_interval(u0);
    u[1] = acdf_unit_interval(u1);
    acdf_sphere_ranges(env->columns, env->rows, range);
    p = acdf_tree_draw(env->tree, env->tree_units, env->root, u, range);
    return acdf_grid_place(&grid, range, u, p);
}

/* acdf_environment_sample without `cells`. */
ACDF_OUTLINE AcdfDirectionSample acdf_environment_other_sample(const AcdfEnvironment* env, double u0, double u1) {
    const AcdfGrid grid = acdf_environment_grid(env);
    AcdfDirectionSample out;
    if (env->groups && acdf_groups_sample(env->groups, &grid, u0, u1, &out)) return out;
    return acdf_environment_walk_sample(env, u0, u1);
}

/* Draws a direction. u0 (phi or u) and u1 (theta or v) in [0, 1]; values outside are clamped, NaN counts as 0.
 * Monotone in each of them within a segment: strata of random numbers stay strata of directions. (Inlined: what is
 * returned by a call goes through memory, in parts that are waited for longer than the tables take.) */
ACDF_INLINE AcdfDirectionSample acdf_environment_sample(const AcdfEnvironment* env, double u0, double u1) {
    AcdfDirectionSample out;
    if (env->cells && acdf_cells_sample(env->cells, u0, u1, &out)) return out;
#ifdef ACDF_ON_GPU
    const AcdfEnvironment rare = *env; /* what is called gets its address: *env stays in registers */
    return acdf_environment_other_sample(&rare, u0, u1);
#else
    return acdf_environment_other_sample(env, u0, u1);
#endif
}

/* Where a direction falls: its cell and, if `strata` is not null, the random numbers that lead there; if that
 * or a tilt asks for them, also the fractions t[axis] across the cell in the measures of the axes. Returns the
 * cell's probability; 0 for directions that are NaN or whose length differs from 1 by more than about 5e-4. */
ACDF_FN double acdf_environment_find(const AcdfEnvironment* env, const float direction[3], AcdfRange range[2],
                                     double t[2], AcdfStratum* strata) {
    const AcdfGrid grid = acdf_environment_grid(env);
    double position[2], p;
    uint32_t square[2];
    if (!acdf_grid_square(&grid, direction, square, position)) return 0.0;
    acdf_sphere_ranges(env->columns, env->rows, range);
    p = strata ? acdf_tree_find(env->tree, env->root, square, range, strata)
               : acdf_tree_locate(env->tree, env->tree_units, env->root, square, range);
    t[0] = t[1] = 0.5;
    if (strata || range[0].tilt != 0.0 || range[1].tilt != 0.0)
        acdf_grid_fractions(&grid, direction, position, range, t);
    return p;
}

/* acdf_environment_pdf by the tree alone. */
ACDF_OUTLINE float acdf_environment_walk_pdf(const AcdfEnvironment* env, const float direction[3]) {
    const AcdfGrid grid = acdf_environment_grid(env);
    AcdfRange range[2];
    double t[2];
    const double p = acdf_environment_find(env, direction, range, t, 0);
    return p > 0.0 ? acdf_grid_pdf(&grid, range, t, p) : 0.0f;
}

/* acdf_environment_pdf without `cells`. */
ACDF_OUTLINE float acdf_environment_other_pdf(const AcdfEnvironment* env, const float direction[3]) {
    const AcdfGrid grid = acdf_environment_grid(env);
    float pdf;
    if (env->groups && acdf_groups_pdf(env->groups, &grid, direction, &pdf)) return pdf;
    return acdf_environment_walk_pdf(env, direction);
}

/* Density per steradian with which acdf_environment_sample draws `direction` (unit). 0 where none falls,
 * and for directions that are NaN or not of unit length. */
ACDF_INLINE float acdf_environment_pdf(const AcdfEnvironment* env, const float direction[3]) {
    float pdf;
    if (env->cells && acdf_cells_pdf(env->cells, direction, &pdf)) return pdf;
#ifdef ACDF_ON_GPU
    const AcdfEnvironment rare = *env; /* as above */
    const float given[3] = {direction[0], direction[1], direction[2]};
    return acdf_environment_other_pdf(&rare, given);
#else
    return acdf_environment_other_pdf(env, direction);
#endif
}

/* The random numbers u[2] for which acdf_environment_sample returns `direction`. Returns 1, or 0 (and u
 * unset) where the density is 0. */
ACDF_FN int acdf_environment_invert(const AcdfEnvironment* env, const float direction[3], double u[2]) {
    AcdfRange range[2];
    AcdfStratum strata[2];
    double t[2];
    int axis;
    strata[0].low = strata[1].low = 0.0;
    strata[0].width = strata[1].width = 1.0;
    if (!(acdf_environment_find(env, direction, range, t, strata) > 0.0)) return 0;
    for (axis = 0; axis < 2; ++axis) u[axis] = acdf_stratum_number(&strata[axis], &range[axis], t[axis]);
    return 1;
}

#ifdef __cplusplus
}
#endif
#endif
