/* A cone of directions with a round profile, as that of a sun in a map: its pdf falls from the middle to the edge.
 * With x = (1 - cos(angle)) / (1 - cos(radius)) and k = 2^roots the pdf is in proportion to (1 - x)^(k - 1), so
 * that x is found by square roots alone. Valid C99, C++17 and CUDA/HIP/SYCL. */
#ifndef ACDF_INDEXED_CONE_H
#define ACDF_INDEXED_CONE_H

#include <acdf/sphere.h>

#ifdef __cplusplus
extern "C" {
#endif
/* A cone about an axis. */
typedef struct AcdfCone {
    double axis[3], side[2][3]; /* unit, at right angles */
    double reach;               /* 1 - cos(radius); 0: there is none */
    double peak;                /* pdf in the middle, sr^-1 */
    double least;               /* 1 - x of samples, at least: ACDF_BORDER inside the edge */
    uint32_t roots;             /* 0: even */
} AcdfCone;
/* The scalar product. */
ACDF_FN double acdf_cone_dot(const double a[3], const double b[3]) {
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

/* The cone about a unit axis; the radius is in [2^-10, 1]. */
ACDF_FN void acdf_cone_about(const double axis[3], double radius, uint32_t roots, AcdfCone* cone) {
    const double sign = axis[2] < 0.0 ? -1.0 : 1.0, a = -1.0 / (sign + axis[2]), b = axis[0] * axis[1] * a;
    const double half = acdf_sine(0.5 * radius);
    int i;
    for (i = 0; i < 3; ++i) cone->axis[i] = axis[i];
    cone->side[0][0] = 1.0 + sign * axis[0] * axis[0] * a;
    cone->side[0][1] = sign * b;
    cone->side[0][2] = -sign * axis[0];
    cone->side[1][0] = b;
    cone->side[1][1] = sign + axis[1] * axis[1] * a;
    cone->side[1][2] = -axis[1];
    cone->reach = 2.0 * half * half;
    cone->peak = (double)(1u << roots) / (2.0 * ACDF_PI * cone->reach);
    cone->least = 2.0 * ACDF_BORDER / radius;
    cone->roots = roots;
}

/* (1 - cos(angle)) / reach of a direction of about unit length: 1 or more outside the cone. */
ACDF_INLINE double acdf_cone_place(const AcdfCone* cone, const float direction[3]) {
    double d[3] = {direction[0], direction[1], direction[2]}, length, square = 0.0;
    int i;
    if (!(acdf_cone_dot(d, cone->axis) > 0.998 - cone->reach)) return 1.0;
    length = sqrt(acdf_cone_dot(d, d));
    for (i = 0; i < 3; ++i) {
        const double away = d[i] / length - cone->axis[i];
        square += away * away;
    }
    return 0.5 * square / cone->reach;
}

/* The pdf at such an x, sr^-1. */
ACDF_INLINE double acdf_cone_pdf(const AcdfCone* cone, double place) {
    const double y = 1.0 - place;
    double power = 1.0;
    uint32_t i;
    if (!(y > 0.0)) return 0.0;
    for (i = 0; i < cone->roots; ++i) power = power * power * y;
    return cone->peak * power;
}
/* The direction of random numbers: u[0] around the axis, u[1] from it. */
ACDF_FN void acdf_cone_sample(const AcdfCone* cone, const double u[2], float direction[3]) {
    double y = 1.0 - u[1], away, sine, side[2];
    uint32_t i;
    for (i = 0; i < cone->roots; ++i) y = sqrt(y);
    away = cone->reach * (1.0 - (y > cone->least ? y : cone->least)); /* inside, once it is rounded */
    sine = sqrt(away * (2.0 - away));
    acdf_sincospi(2.0 * u[0], &side[1], &side[0]);
    for (i = 0; i < 3; ++i)
        direction[i] = (float)(cone->axis[i] * (1.0 - away) +
                               sine * (side[0] * cone->side[0][i] + side[1] * cone->side[1][i]));
}

/* The random numbers of a direction in the cone, at x. */
ACDF_FN void acdf_cone_invert(const AcdfCone* cone, const float direction[3], double place, double u[2]) {
    const double d[3] = {direction[0], direction[1], direction[2]};
    const double turn = 0.5 * acdf_atan2pi(acdf_cone_dot(d, cone->side[1]), acdf_cone_dot(d, cone->side[0]));
    double y = 1.0 - place;
    uint32_t i;
    for (i = 0; i < cone->roots; ++i) y = y * y;
    u[0] = turn < 0.0 ? turn + 1.0 : turn;
    u[1] = 1.0 - y;
}

#ifdef __cplusplus
}
#endif
#endif
