/* Cells of a tree with what a sample and a pdf need precomputed: parts of the pieces of the sphere (acdf/pieces.h),
 * or of the octahedral square (acdf/shader_square.h), by which the runtime tables of local environments answer. */
#ifndef ACDF_CELLS_H
#define ACDF_CELLS_H

#include <acdf/pieces.h>
#include <acdf/shader_square.h>
#include <acdf/sphere.h>
#include <acdf/squares.h>

#ifdef __cplusplus
extern "C" {
#endif

/* The random numbers of an axis that surely lead into a piece, and where they lead. They begin at low, in steps of
 * 2^-31; d steps of 2^-52 above it, 0 <= d < width, the local azimuth (radians), 1 - |z| or the place on an axis of
 * the square is origin + d * slope.
 * In the south `low` is the upper end, at the pole, and -width < d < 0. Directions from origin to there surely lie
 * in the piece; where numbers do not tell (they may be too few, or none) only that is meant. */
typedef struct AcdfPieceAxis {
    uint32_t low;
    float width; /* its lowest bits: of azimuth two, the quarter; of height one, whether it is south; else 0 */
    float origin, slope;
} AcdfPieceAxis;
typedef struct AcdfPiece {
    AcdfPieceAxis azimuth, height;
} AcdfPiece;

/* ---- drawing ---------------------------------------------------------------------------------------- */

/* Numbers in [0, 1) in steps of 2^-52, which are the bits of their fractions where 1 is added. Returns 0 for
 * others.
 */
ACDF_INLINE int acdf_number_steps(double u0, double u1, uint64_t n[2]) {
    const double shifted0 = u0 + 1.0, shifted1 = u1 + 1.0;
    memcpy(&n[0], &shifted0, sizeof shifted0);
    memcpy(&n[1], &shifted1, sizeof shifted1);
    n[0] ^= 0x3FF0000000000000u;
    n[1] ^= 0x3FF0000000000000u;
    return (n[0] | n[1]) >> 52 == 0;
}

/* d of a number in steps of 2^-52. */
ACDF_INLINE float acdf_draw_distance(uint64_t number, uint32_t low) {
    return (float)(int64_t)(number - ((uint64_t)low << 21));
}

/* ---- finding ---------------------------------------------------------------------------------------- */

/* Whether floats tell a direction, by its x x + y y and the square of its length: 0.9999 to 1.0001 and 2^-40 up, by
 * their bits, which tell what is not finite, too. */
ACDF_INLINE int acdf_is_direction(float sin2, float length2) {
    return acdf_float_bits(length2) - 0x3F7FF972u <= 0x000009D4u && acdf_float_bits(sin2) >= 0x2B800000u;
}

/* Where a direction lies: in place->slope not the tangent of the local azimuth but that itself. Returns 0 where
 * floats do not tell: within 2^-20 of a pole, and for directions whose length differs from 1 by more than 5e-5 or
 * that are not finite. */
ACDF_INLINE int acdf_direction_place(uint32_t octahedral, const float direction[3], AcdfPlace* place) {
    const float x = direction[0], y = direction[1], z = direction[2];
    const float sin2 = x * x + y * y, length2 = sin2 + z * z;
    if (!acdf_is_direction(sin2, length2)) return 0;
    if (octahedral) {
        *place = acdf_square_place(x, y, z, sin2, length2);
    } else {
        *place = acdf_place_of(x, y, z, sin2, length2);
        place->slope = acdf_atan_float(place->slope);
    }
    return 1;
}

#ifdef __cplusplus
}
#endif
#endif
