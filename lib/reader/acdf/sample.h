/* Sampling and evaluating .acdf environments: freestanding headers, valid C99, C++17 and CUDA/HIP/SYCL.
 * acdf/tree.h has the trees, acdf/sphere.h the sphere, acdf/random.h random numbers, acdf/elementary.h the rest.
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
#include <acdf/random.h>
#include <acdf/sphere.h>

#ifdef __cplusplus
extern "C" {
#endif

typedef struct AcdfEnvironment {
    const uint8_t* tree; /* chunk TREE */
    uint32_t root;
    uint32_t columns;       /* axis 0: position 0 is phi = +pi, `columns` is phi = -pi */
    uint32_t rows;          /* axis 1: position 0 is theta = 0 (+z), `rows` is theta = pi */
    double total;           /* integral of the target over the sphere */
    const AcdfCells* cells; /* runtime tables; null: the tree is walked */
} AcdfEnvironment;

/* acdf_environment_sample by the tree alone. */
ACDF_OUTLINE AcdfDirectionSample acdf_environment_walk_sample(const AcdfEnvironment* env, double u0, double u1) {
    double u[2], p;
    AcdfRange range[2];
    u[0] = acdf_unit_interval(u0);
    u[1] = acdf_unit_interval(u1);
    acdf_sphere_ranges(env->columns, env->rows, range);
    p = acdf_tree_sample(env->tree, env->root, u, range);
    return acdf_sphere_place(env->columns, env->rows, range, u, p);
}

/* Draws a direction. u0 (phi) and u1 (theta) in [0, 1]; values outside are clamped, NaN counts as 0.
 * Monotone in each of them within a segment: strata of random numbers stay strata of directions. (Inlined: what is
 * returned by a call goes through memory, in parts that are waited for longer than the tables take.) */
ACDF_INLINE AcdfDirectionSample acdf_environment_sample(const AcdfEnvironment* env, double u0, double u1) {
    AcdfDirectionSample out;
    if (env->cells && acdf_cells_sample(env->cells, u0, u1, &out)) return out;
    return acdf_environment_walk_sample(env, u0, u1);
}

/* Where a direction falls: its cell and, if `strata` is not null, the random numbers that lead there; if that
 * or a tilt asks for them, also the fractions t[axis] across the cell (t[1] in z). Returns the cell's
 * probability; 0 for directions that are NaN or whose length differs from 1 by more than about 5e-4. */
ACDF_FN double acdf_environment_find(const AcdfEnvironment* env, const float direction[3], AcdfRange range[2],
                                     double t[2], double dz[1], AcdfStratum* strata) {
    double column, p, z0;
    uint32_t square[2];
    if (!acdf_sphere_square(env->columns, env->rows, direction, square, &column)) return 0.0;
    acdf_sphere_ranges(env->columns, env->rows, range);
    p = acdf_tree_find(env->tree, env->root, square, range, strata);
    z0 = acdf_row_z(range[1].low, env->rows);
    dz[0] = z0 - acdf_row_z(range[1].high, env->rows);
    t[0] = t[1] = 0.5;
    if (strata || range[0].tilt != 0.0 || range[1].tilt != 0.0)
        acdf_sphere_fractions(direction, column, range, z0, dz[0], t);
    return p;
}

/* acdf_environment_pdf by the tree alone. */
ACDF_OUTLINE float acdf_environment_walk_pdf(const AcdfEnvironment* env, const float direction[3]) {
    AcdfRange range[2];
    double t[2], dz[1];
    const double p = acdf_environment_find(env, direction, range, t, dz, 0);
    if (!(p > 0.0)) return 0.0f;
    return acdf_cell_pdf(p, range[0].high - range[0].low, env->columns, dz[0],
                         acdf_tilt_density(range[0].tilt, t[0]) * acdf_tilt_density(range[1].tilt, t[1]));
}

/* Density per steradian with which acdf_environment_sample draws `direction` (unit). 0 where none falls,
 * and for directions that are NaN or not of unit length. */
ACDF_INLINE float acdf_environment_pdf(const AcdfEnvironment* env, const float direction[3]) {
    float pdf;
    if (env->cells && acdf_cells_pdf(env->cells, direction, &pdf)) return pdf;
    return acdf_environment_walk_pdf(env, direction);
}

/* The random numbers u[2] for which acdf_environment_sample returns `direction`. Returns 1, or 0 (and u
 * unset) where the density is 0. */
ACDF_FN int acdf_environment_invert(const AcdfEnvironment* env, const float direction[3], double u[2]) {
    AcdfRange range[2];
    AcdfStratum strata[2];
    double t[2], dz[1];
    int axis;
    strata[0].low = strata[1].low = 0.0;
    strata[0].width = strata[1].width = 1.0;
    if (!(acdf_environment_find(env, direction, range, t, dz, strata) > 0.0)) return 0;
    for (axis = 0; axis < 2; ++axis)
        u[axis] = strata[axis].low + strata[axis].width * acdf_tilt_cdf(range[axis].tilt, t[axis]);
    return 1;
}

#ifdef __cplusplus
}
#endif
#endif
