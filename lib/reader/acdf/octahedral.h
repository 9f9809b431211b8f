/* The equal-area octahedral square (SPEC.md §6.6): P. Clarberg, "Fast Equal-Area Mapping of the (Hemi)Sphere using
 * SIMD", Journal of Graphics Tools 13(3), 2008.
 *
 * +z lies in the middle of the square, -z in its four corners, the equator on the diamond between the middles of
 * its sides. Every part of the square shows its share of 4 pi steradians. The map is continuous inside the square;
 * the halves of each side show the same directions, mirrored at its middle. */
#ifndef ACDF_OCTAHEDRAL_H
#define ACDF_OCTAHEDRAL_H

#include <acdf/elementary.h>

#ifdef __cplusplus
extern "C" {
#endif

/* A point of the square that moves by one along an axis moves on the sphere by at least this angle (radians) away
 * from the line that it left, and by at most ACDF_OCTAHEDRAL_SPEED in all. */
#define ACDF_OCTAHEDRAL_LEAST_SPEED 2.386
#define ACDF_OCTAHEDRAL_SPEED 5.266

/* The unit direction shown at (u, v), both in [0, 1]. */
ACDF_FN void acdf_octahedral_direction(double u, double v, double direction[3]) {
    const double a = fabs(2.0 * u - 1.0), b = fabs(2.0 * v - 1.0);
    const double beyond = a + b - 1.0; /* the equator; > 0: the lower hemisphere */
    const double r = 1.0 - fabs(beyond), sine = r * sqrt(1.0 - 0.5 * r * r); /* over sqrt(2) */
    /* phi is pi / 4 and this, which is between -pi / 4 and pi / 4. */
    const double turn = r > 0.0 ? (b - a) / r * (0.25 * ACDF_PI) : 0.0;
    const double s = acdf_sine(turn), c = acdf_cosine(turn), x = sine * (c - s), y = sine * (c + s);
    direction[0] = u > 0.5 ? -x : x;
    direction[1] = v < 0.5 ? -y : y;
    direction[2] = -beyond * (1.0 + r); /* 1 - r^2, exact near the equator */
}

/* Where the square shows a direction of any positive length: u and v in [0, 1]. */
ACDF_FN void acdf_octahedral_point(const double direction[3], double* u, double* v) {
    const double x = fabs(direction[0]), y = fabs(direction[1]), z = fabs(direction[2]);
    const double sin2 = x * x + y * y, length = sqrt(sin2 + z * z);
    const double r = sqrt(sin2 / (length * (length + z))); /* sqrt(1 - |z|), exact near the poles */
    double b = 2.0 * acdf_atan2pi(y, x) * r, a = r - b;
    if (direction[2] < 0.0) { /* folded over the diamond */
        const double inner = a;
        a = 1.0 - b;
        b = 1.0 - inner;
    }
    *u = acdf_clamp(direction[0] > 0.0 ? 0.5 - 0.5 * a : 0.5 + 0.5 * a, 0.0, 1.0);
    *v = acdf_clamp(direction[1] < 0.0 ? 0.5 - 0.5 * b : 0.5 + 0.5 * b, 0.0, 1.0);
}

#ifdef __cplusplus
}
#endif
#endif
