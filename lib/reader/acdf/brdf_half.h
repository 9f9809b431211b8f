/* Half-vectors of a BRDF file: where in the table they lie, and what they reflect (SPEC.md §11). */
#ifndef ACDF_BRDF_HALF_H
#define ACDF_BRDF_HALF_H

#include <acdf/brdf_view.h>

#ifdef __cplusplus
extern "C" {
#endif

/* A direction as a position in the table. */
typedef struct AcdfBrdfPosition {
    double position[2];
    double dot, length; /* |wo . (wo + wi)| and |wo + wi|: the cosine |wo . wh| is dot / length */
} AcdfBrdfPosition;

/* wo + wi and its length. Returns 0 where wi is not of unit length or opposite to wo. */
ACDF_INLINE int acdf_brdf_half(const AcdfBrdfView* view, const float wi[3], double half[3],
                               AcdfBrdfPosition* place) {
    const double x = wi[0], y = wi[1], z = wi[2], length2 = x * x + y * y + z * z;
    half[0] = view->wo[0] + x;
    half[1] = view->wo[1] + y;
    half[2] = view->wo[2] + z;
    place->length = acdf_brdf_root(half[0] * half[0] + half[1] * half[1] + half[2] * half[2]);
    place->dot = fabs(view->wo[0] * half[0] + view->wo[1] * half[1] + view->wo[2] * half[2]);
    return acdf_is_unit_square(length2) && place->length > 0.0;
}

/* atan2(y, x) / pi for y >= 0 as acdf_atan2pi has it, but for rounding and without branches: the octant of a
 * half-vector cannot be guessed. */
ACDF_INLINE double acdf_brdf_azimuth(double y, double x) {
    const double ax = fabs(x), high = ax > y ? ax : y, low = ax < y ? ax : y;
    const double narrow = 0.41421356237309503 * high, beyond = acdf_if_less(narrow, low, high);
    const double w = high > 0.0 ? (low - beyond) / (high + acdf_if_less(narrow, low, low)) : 0.0;
    double turn = acdf_if_less(narrow, low, 0.25) + acdf_narrow_atanpi(w);
    turn = acdf_if_less(ax, y, 0.5) + acdf_sign(ax - y) * turn;
    return acdf_if_less(x, 0.0, 1.0) + acdf_sign(x + 0.0) * turn;
}

/* Where a half-vector of this length lies in the table; `sign` is on which side of the mirror. */
ACDF_INLINE void acdf_brdf_position(const AcdfBrdf* brdf, const AcdfBrdfView* view, const double half[3],
                                    double length, double position[2], double* sign) {
    const double below = acdf_sign(half[2] + 0.0); /* one below the surface reflects as its opposite does */
    const double hx = below * (view->turn[0] * half[0] + view->turn[1] * half[1]);
    const double hy = below * (view->turn[0] * half[1] - view->turn[1] * half[0]);
    const double phi = acdf_brdf_azimuth(fabs(hy), hx);
    *sign = acdf_sign(hy + 0.0);
    position[0] = (double)brdf->columns * (acdf_brdf_mirrored(brdf) ? phi : 0.5 + 0.5 * *sign * phi);
    position[1] = (double)brdf->rows * ((half[0] * half[0] + half[1] * half[1]) /
                                        (length * (length + fabs(half[2])))); /* no cancellation */
}

/* Position of the half-vector of wo and wi; `sign` is on which side of the mirror it lies. Returns 0 where wi is
 * not of unit length or opposite to wo. */
ACDF_INLINE int acdf_brdf_half_position(const AcdfBrdf* brdf, const AcdfBrdfView* view, const float wi[3],
                                        AcdfBrdfPosition* place, double* sign) {
    double half[3];
    if (!acdf_brdf_half(view, wi, half, place)) return 0;
    acdf_brdf_position(brdf, view, half, place->length, place->position, sign);
    return 1;
}

ACDF_INLINE uint32_t acdf_brdf_step(double position, uint32_t resolution) {
    return position < (double)resolution ? (uint32_t)position : resolution - 1;
}

/* Rows of half-vectors of a tree of halvings (ACDF_MEASURE_HALF): the last 360 are equal steps of sqrt(theta_h), so
 * that halving meets the borders of measurements that tabulate it in 90 steps. The others lie at the pole. */
enum { ACDF_HALF_ROWS = 512, ACDF_HALF_ROWS_AT_POLE = 152 };
#define ACDF_HALF_STEPS 0x10000000u /* of 1 - cos(theta_h) */

/* Where a row begins, in steps of 2^-28 of 1 - cos(theta_h), rounded down; each row has a step at least. No number
 * that is rounded is nearer than 1e-3 to a whole one: every machine has the same. */
ACDF_FN uint32_t acdf_half_row(uint32_t row) {
    static const double divisor[] = {306.0, 240.0, 182.0, 132.0, 90.0, 56.0, 30.0, 12.0};
    const double t = ((double)row - (double)ACDF_HALF_ROWS_AT_POLE) / 360.0;
    const double angle2 = t > 0.0 ? 0.25 * ACDF_PI * ACDF_PI * (t * t) * (t * t) : 0.0;
    double sum = 1.0;
    uint32_t low, i;
    for (i = 0; i < 8; ++i) sum = 1.0 - angle2 / divisor[i] * sum; /* of 1 - cos(x): x^2 / 2 (1 - x^2 / 12 (...)) */
    low = (uint32_t)(0.5 * angle2 * sum * (double)ACDF_HALF_STEPS);
    return low < row ? row : low;
}

/* The row that holds a position; `begins`: acdf_half_row of each. */
ACDF_INLINE uint32_t acdf_half_row_of(const double* begins, double position) {
    const double c = position * (1.0 / (double)ACDF_HALF_STEPS);
    /* The square of theta_h as a series in 1 - cos(theta_h), to a row. */
    const double angle2 = c * (2.0 + c * (1.0 / 3.0 + c * (4.0 / 45.0 + c * (1.0 / 35.0 + c * (16.0 / 1575.0)))));
    const double guess = (double)ACDF_HALF_ROWS_AT_POLE +
                         360.0 * 0.79788456080286541 * acdf_brdf_root(acdf_brdf_root(angle2)); /* sqrt(2 / pi) */
    uint32_t row = (uint32_t)(guess < position ? guess : position);
    while (begins[row] > position) --row;
    while (row + 1u < (uint32_t)ACDF_HALF_ROWS && begins[row + 1u] <= position) ++row;
    return row;
}

/* Reflects wo at the half-vector at x, a part of axis 0, of which cap is 1 - cos(theta_h). Returns how long wo + wi
 * is; *radius is sin(theta_h). */
ACDF_INLINE double acdf_brdf_reflect_at(const AcdfBrdf* brdf, const AcdfBrdfView* view, double x, double cap,
                                        double sign, float wi[3], double* radius) {
    const double hz = 1.0 - cap, sin_theta = acdf_brdf_root(cap * (2.0 - cap));
    const double scale = sin_theta / acdf_brdf_root(view->turn[0] * view->turn[0] + view->turn[1] * view->turn[1]);
    double sine, cosine, hx, hy, dot;
    acdf_sincospi(acdf_brdf_mirrored(brdf) ? sign * x : 2.0 * x - 1.0, &sine, &cosine);
    hx = scale * (view->turn[0] * cosine - view->turn[1] * sine);
    hy = scale * (view->turn[1] * cosine + view->turn[0] * sine);
    dot = 2.0 * (view->wo[0] * hx + view->wo[1] * hy + view->wo[2] * hz);
    wi[0] = (float)(dot * hx - view->wo[0]);
    wi[1] = (float)(dot * hy - view->wo[1]);
    wi[2] = (float)(dot * hz - view->wo[2]);
    *radius = sin_theta;
    return fabs(dot);
}

/* The same at a position. `reach`: rounding wi to float moves its position by less. A float below 1 is off by 2^-25
 * at most, so wi by 0.87 * 2^-24 and the half-vector, since wo + wi is 2 |wo . wh| long, by half of that over the
 * cosine; here twice as much. Not finite or NaN at the pole. */
ACDF_INLINE void acdf_brdf_reflect(const AcdfBrdf* brdf, const AcdfBrdfView* view, const double position[2],
                                   double sign, float wi[3], double reach[2]) {
    double radius, turn, angle;
    const double dot = acdf_brdf_reflect_at(brdf, view, position[0] / (double)brdf->columns,
                                            position[1] / (double)brdf->rows, sign, wi, &radius);
    turn = 0x1p-23 / (dot * radius); /* of its azimuth: 0x1p-24 over the cosine and the radius */
    angle = turn * radius;
    reach[0] = (double)brdf->columns * turn; /* of a half or a whole turn: pi or more to spare */
    reach[1] = (double)brdf->rows * (angle * (radius + angle));
}

/* Whether a position is in a cell and farther than `reach` from its border. */
ACDF_INLINE int acdf_brdf_inside(const AcdfRange range[2], const double position[2], const double reach[2]) {
    return position[0] >= (double)range[0].low + reach[0] && position[0] < (double)range[0].high - reach[0] &&
           position[1] >= (double)range[1].low + reach[1] && position[1] < (double)range[1].high - reach[1];
}

/* Both halves of u0 run through the same table: strata stay strata. Returns on which side of the mirror wi lies. */
ACDF_INLINE double acdf_brdf_mirror(double* u0) {
    const double v = 2.0 * *u0 - 1.0;
    *u0 = fabs(v);
    return v < 0.0 ? -1.0 : 1.0;
}

/* The pdf of wi where a cell of probability p covers `area` grid squares. */
ACDF_INLINE double acdf_brdf_mean_pdf(const AcdfBrdf* brdf, double p, double area, const AcdfBrdfPosition* place) {
    return p * (double)brdf->columns * (double)brdf->rows * place->length / (8.0 * ACDF_PI * place->dot * area);
}

#ifdef __cplusplus
}
#endif
#endif
