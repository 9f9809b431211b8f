/* Where a direction lies in the pieces of the sphere (acdf/pieces.h), or on the octahedral square
 * (acdf/octahedral_float.h), by which the runtime tables of local environments answer. */
#ifndef ACDF_CELLS_H
#define ACDF_CELLS_H

#include <acdf/octahedral_float.h>
#include <acdf/pieces.h>
#include <acdf/sphere.h>
#include <acdf/squares.h>

#ifdef __cplusplus
extern "C" {
#endif

/* Whether floats decide a direction, by its x x + y y and the square of its length: 0.9999 to 1.0001 and 2^-40 up.
 * It compares their bits, which also excludes what is not finite. */
ACDF_INLINE int acdf_is_direction(float sin2, float length2) {
    return acdf_float_bits(length2) - 0x3F7FF972u <= 0x000009D4u && acdf_float_bits(sin2) >= 0x2B800000u;
}

/* Where a direction lies: in place->slope not the tangent of the local azimuth but that itself. Returns 0 where
 * floats cannot decide: within 2^-20 of a pole, and for directions whose length differs from 1 by more than 5e-5 or
 * that are not finite. */
ACDF_INLINE int acdf_keys_of_direction(uint32_t octahedral, const float direction[3], AcdfDirectionKeys* place) {
    const float x = direction[0], y = direction[1], z = direction[2];
    const float sin2 = x * x + y * y, length2 = sin2 + z * z;
    if (!acdf_is_direction(sin2, length2)) return 0;
    if (octahedral) {
        *place = acdf_square_keys(x, y, z, sin2, length2);
    } else {
        *place = acdf_direction_keys(x, y, z, sin2, length2);
        place->slope = acdf_atan_float(place->slope);
    }
    return 1;
}

#ifdef __cplusplus
}
#endif
#endif
