/* The octahedral square (acdf/octahedral.h) in floats, and angles of any size. One text for processors and for
 * shaders of every language (acdf/dialect.h). */
#ifndef ACDF_SHADER_SQUARE_H
#define ACDF_SHADER_SQUARE_H

#include <acdf/pieces.h>

#ifdef __cplusplus
extern "C" {
#endif

/* ---- the octahedral square -------------------------------------------------------------------------- */

#define ACDF_SQUARE_STEPS 16777216.0f

/* Angle of (x, y) over pi for y >= 0, in [0, 1]; not both 0. Error below 1e-7. */
ACDF_FN2(ACDF_F32, acdf_half_turns, ACDF_F32, y, ACDF_F32, x) {
    ACDF_LET(ACDF_F32, across) = ACDF_ABS(x);
    if (y > across) {
        return 0.5f - 0.31830989f * acdf_atan_float(ACDF_RATIO(x, y));
    }
    ACDF_LET(ACDF_F32, turn) = 0.31830989f * acdf_atan_float(ACDF_RATIO(y, across));
    return ACDF_SELECT(x < 0.0f, 1.0f - turn, turn);
}

/* Cosine (x) and sine (y) of 2 pi u - pi, for u in [0, 1]. */
ACDF_FN1(AcdfVector, acdf_turn, ACDF_F32, u) {
    ACDF_LET(ACDF_U32, quarter) = ACDF_TO_U32(4.0f * u + 0.5f);
    ACDF_LET(ACDF_F32, angle) = (4.0f * u - ACDF_TO_F32(quarter)) * 1.5707963f;
    ACDF_LET(ACDF_F32, s) = acdf_sine_float(angle);
    ACDF_LET(ACDF_F32, c) = acdf_cosine_float(angle);
    ACDF_LET(ACDF_F32, sign) = ACDF_SELECT((quarter & 2u) != 0u, -1.0f, 1.0f);
    return acdf_vector(ACDF_SELECT((quarter & 1u) != 0u, s, -c) * sign,
                       ACDF_SELECT((quarter & 1u) != 0u, -c, -s) * sign, 0.0f);
}

/* The unit direction shown at (u, v), both in [0, 1]. */
ACDF_FN2(AcdfVector, acdf_square_direction, ACDF_F32, u, ACDF_F32, v) {
    ACDF_LET(ACDF_F32, a) = ACDF_ABS(2.0f * u - 1.0f);
    ACDF_LET(ACDF_F32, b) = ACDF_ABS(2.0f * v - 1.0f);
    ACDF_LET(ACDF_F32, beyond) = a + b - 1.0f; /* the equator */
    ACDF_LET(ACDF_F32, r) = ACDF_MAX(1.0f - ACDF_ABS(beyond), 1e-12f);
    ACDF_LET(ACDF_F32, sine) = r * ACDF_SQRT(1.0f - 0.5f * r * r); /* over sqrt(2) */
    ACDF_LET(ACDF_F32, turn) = ACDF_RATIO(b - a, r) * 0.78539816f;
    ACDF_LET(ACDF_F32, s) = acdf_sine_float(turn);
    ACDF_LET(ACDF_F32, c) = acdf_cosine_float(turn);
    ACDF_VAR(AcdfVector, d);
    d.x = ACDF_SELECT(u > 0.5f, -sine, sine) * (c - s);
    d.y = ACDF_SELECT(v < 0.5f, -sine, sine) * (c + s);
    d.z = -beyond * (1.0f + r);
    return d;
}

/* Where the square shows a direction of nearly unit length, in steps of 2^-24; sin2 and length2 as of
 * acdf_place_of. */
ACDF_FN5(AcdfPlace, acdf_square_place, ACDF_F32, x, ACDF_F32, y, ACDF_F32, z, ACDF_F32, sin2, ACDF_F32, length2) {
    ACDF_LET(ACDF_F32, length) = ACDF_SQRT(length2);
    ACDF_LET(ACDF_F32, r) = ACDF_SQRT(sin2 / (length * (length + ACDF_ABS(z))));
    ACDF_LET(ACDF_F32, along) = 2.0f * acdf_half_turns(ACDF_ABS(y), ACDF_ABS(x)) * r;
    ACDF_LET(ACDF_F32, a) =
        ACDF_SELECT(z < 0.0f, 1.0f - along, r - along); /* in the south folded over the diamond */
    ACDF_LET(ACDF_F32, b) = ACDF_SELECT(z < 0.0f, 1.0f - (r - along), along);
    ACDF_LET(ACDF_F32, u) = ACDF_SELECT(x > 0.0f, 0.5f - 0.5f * a, 0.5f + 0.5f * a);
    ACDF_LET(ACDF_F32, v) = ACDF_SELECT(y < 0.0f, 0.5f - 0.5f * b, 0.5f + 0.5f * b);
    ACDF_VAR(AcdfPlace, place);
    place.slope = ACDF_MIN(ACDF_MAX(u, 0.0f), 0.99999994f);
    place.cap = ACDF_MIN(ACDF_MAX(v, 0.0f), 0.99999994f);
    place.key0 = ACDF_TO_U32(place.slope * ACDF_SQUARE_STEPS);
    place.key1 = ACDF_TO_U32(place.cap * ACDF_SQUARE_STEPS);
    return place;
}

#ifdef __cplusplus
}
#endif
#endif
