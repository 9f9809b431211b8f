/* Directions and cells of the sphere (SPEC.md §6.1). */
#ifndef ACDF_SPHERE_H
#define ACDF_SPHERE_H

#include <acdf/angle_float.h>
#include <acdf/layout.h>
#include <acdf/range.h>

#ifdef __cplusplus
extern "C" {
#endif

typedef struct AcdfDirectionSample {
    float direction[3]; /* unit, towards the light */
    float pdf;          /* sr^-1, finite and > 0 */
} AcdfDirectionSample;

/* A sample that is returned by a call in two registers. Compilers take it out of memory then, where what was
 * written in pieces of 4 bytes is waited for if more are read at once: so it is written at once. */
ACDF_INLINE AcdfDirectionSample acdf_returned(const AcdfDirectionSample* sample) {
#ifdef ACDF_SSE2
    AcdfDirectionSample out;
    const float* d = sample->direction;
    const __m128 all = _mm_setr_ps(d[0], d[1], d[2], sample->pdf);
    memcpy(&out, &all, sizeof out);
    return out;
#else
    return *sample;
#endif
}

enum { ACDF_AXIS_PHI = 0, ACDF_AXIS_THETA = 1 };

/* A sample stays this angle (radians) inside its cell: rounding the direction to float, and normalising it
 * again, then cannot carry it over the border, and pdf() agrees with sample(). */
#define ACDF_BORDER 0x1p-22

/* z = cos(theta) at a row position in [0, rows]: 1 - 2 sin(theta/2)^2, exact at the poles. */
ACDF_FN double acdf_row_z(uint32_t row, uint32_t rows) {
    const uint32_t south = (uint32_t)(2 * (uint64_t)row > rows);
    const uint32_t from = row ^ ((row ^ (rows - row)) & (0u - south)); /* the nearer pole, without a branch */
    const double s = acdf_sine((double)from / (double)rows * (0.5 * ACDF_PI));
    return (1.0 - 2.0 * (double)south) * (1.0 - 2.0 * s * s);
}

/* A pdf of what can be sampled, as a float: finite and > 0. */
ACDF_FN float acdf_positive_pdf(double pdf) {
    if (pdf >= 3.402823466e38) return 3.402823466e38f;
    return pdf > 1.17549435e-38 ? (float)pdf : 1.17549435e-38f;
}
/* Pdf per steradian of a cell of probability p over `width` of `columns` columns and a difference dz of cosines. */
ACDF_FN float acdf_cell_pdf(double p, uint32_t width, uint32_t columns, double dz) {
    return acdf_positive_pdf(p * (double)columns / (2.0 * ACDF_PI * (double)width * dz));
}

/* The whole sphere, before a tree narrows it. */
ACDF_FN void acdf_sphere_ranges(uint32_t columns, uint32_t rows, AcdfRange range[2]) {
    range[0].low = range[1].low = 0;
    range[0].high = columns;
    range[1].high = rows;
}

/* The direction that what is left of the random numbers picks in a cell of probability p, between the heights z0 of
 * its upper and z1 of its lower border. */
ACDF_FN AcdfDirectionSample acdf_sphere_position_between(uint32_t columns, const AcdfRange range[2],
                                                         const double u[2], double p, double z0, double z1) {
    AcdfDirectionSample out;
    double x, z, sin_theta, sine, cosine, border, kept;
    border = (double)columns * (ACDF_BORDER / (2.0 * ACDF_PI));
    x = (double)range[0].low + u[0] * (double)(range[0].high - range[0].low);
    x = acdf_clamp(x, (double)range[0].low + border, (double)range[0].high - border);

    z = z0 + u[1] * (z1 - z0);
    sin_theta = sqrt((1.0 - z) * (1.0 + z));
    border = ACDF_BORDER * sin_theta;
    kept = acdf_clamp(z, z1 + border, z0 - border);
    kept = acdf_clamp(kept, -1.0 + 0.5 * ACDF_BORDER * ACDF_BORDER, 1.0 - 0.5 * ACDF_BORDER * ACDF_BORDER);
    if (kept != z) { /* rarely */
        z = kept;
        sin_theta = sqrt((1.0 - z) * (1.0 + z));
    }

    acdf_sincospi(1.0 - 2.0 * x / (double)columns, &sine, &cosine);
    out.direction[0] = (float)(sin_theta * cosine);
    out.direction[1] = (float)(sin_theta * sine);
    out.direction[2] = (float)z;
    out.pdf = acdf_cell_pdf(p, range[0].high - range[0].low, columns, z0 - z1);
    return out;
}

/* The same of a cell of `rows` rows of the sphere. */
ACDF_FN AcdfDirectionSample acdf_sphere_position(uint32_t columns, uint32_t rows, const AcdfRange range[2],
                                                 const double u[2], double p) {
    return acdf_sphere_position_between(columns, range, u, p, acdf_row_z(range[1].low, rows),
                                        acdf_row_z(range[1].high, rows));
}

/* The grid square of a direction, and where on the columns axis it lies. Returns 0 for directions that are NaN or
 * whose length differs from 1 by more than about 5e-4. */
ACDF_FN int acdf_sphere_square(uint32_t columns, uint32_t rows, const float direction[3], uint32_t square[2],
                               double* column) {
    const double x = direction[0], y = direction[1], z = direction[2];
    const double sin2 = x * x + y * y;
    const double length = sqrt(sin2 + z * z);
    if (!acdf_are_finite(direction) || !(length > 0.9995 && length < 1.0005)) return 0;
    *column = (double)columns * (0.5 - 0.5 * acdf_atan2pi(y, x));
    if (*column >= (double)columns) *column = 0.0; /* phi = -pi is phi = +pi */
    if (*column < 0.0) *column = 0.0;
    square[0] = (uint32_t)*column;
    square[1] = (uint32_t)((double)rows * acdf_atan2pi(sqrt(sin2), z));
    if (square[1] >= rows) square[1] = rows - 1;
    return 1;
}

/* The angle, in radians, of a point of the first quadrant, y and x >= 0 and not both 0: within 2e-7. */
ACDF_INLINE float acdf_angle_nearly(float y, float x) {
    const float low = y < x ? y : x, high = y < x ? x : y, angle = acdf_atan_float(low / high);
    return y > x ? 1.57079633f - angle : angle;
}

/* The position of a direction on both axes, in floats: within error[axis] of what doubles have. Returns 0 for
 * directions at which that is not so: near the poles, and of another length than 1. */
ACDF_INLINE int acdf_sphere_nearly(uint32_t columns, uint32_t rows, const float direction[3], float position[2],
                                   float error[2]) {
    const float x = direction[0], y = direction[1], z = direction[2];
    const float sin2 = x * x + y * y, length2 = sin2 + z * z;
    float turn, angle;
    if (!(length2 > 0.9999f && length2 < 1.0001f && sin2 > 1e-12f)) return 0;
    turn = acdf_angle_nearly(fabsf(y), fabsf(x)) * 0.15915494f;
    turn = x < 0.0f ? 0.5f - turn : turn;
    angle = acdf_angle_nearly(sqrtf(sin2), fabsf(z)) * 0.31830989f;
    position[0] = (float)columns * (y < 0.0f ? 0.5f + turn : 0.5f - turn);
    position[1] = (float)rows * (z < 0.0f ? 1.0f - angle : angle);
    error[0] = (float)columns * 4e-7f;
    error[1] = (float)rows * 4e-7f;
    return 1;
}

/* The fractions t[axis] at which a direction lies across its cell (t[1] in z, from z0 down by dz). */
ACDF_FN void acdf_sphere_fractions(const float direction[3], double column, const AcdfRange range[2], double z0,
                                   double dz, double t[2]) {
    const double x = direction[0], y = direction[1], z = direction[2];
    const double sin2 = x * x + y * y;
    const double length = sqrt(sin2 + z * z);
    const double cap =
        sin2 / (length * (length + fabs(z))); /* 1 - |cos(theta)|, exact near the poles where z is not */
    t[0] = acdf_clamp((column - (double)range[0].low) / (double)(range[0].high - range[0].low), 0.0, 1.0);
    t[1] = acdf_clamp((z0 - (z < 0.0 ? cap - 1.0 : 1.0 - cap)) / dz, 0.0, 1.0);
}

#ifdef __cplusplus
}
#endif
#endif
