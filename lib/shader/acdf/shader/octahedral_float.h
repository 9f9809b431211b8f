/* The octahedral square (acdf/octahedral.h) in floats, and angles of any size. One text for processors and for
 * shaders of every language (acdf/shader/dialect.h). */
#ifndef ACDF_SHADER_OCTAHEDRAL_FLOAT_H
#define ACDF_SHADER_OCTAHEDRAL_FLOAT_H

#include <acdf/shader/pieces.h>

#ifdef __cplusplus
extern "C" {
#endif

/* ---- the octahedral square -------------------------------------------------------------------------- */

#define ACDF_SQUARE_BITS 24u /* of keys */
#define ACDF_SQUARE_STEPS 16777216.0f
#define ACDF_SQUARE_HALF 8388608.0f
#define ACDF_SQUARE_LAST 16777215.0f

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

/* The unit direction shown at 1 - 2 u and 2 v - 1, both in [-1, 1]: signs are those of x and y. */
ACDF_FN2(AcdfVector, acdf_square_direction, ACDF_F32, across, ACDF_F32, along) {
    ACDF_LET(ACDF_F32, a) = ACDF_ABS(across);
    ACDF_LET(ACDF_F32, b) = ACDF_ABS(along);
    ACDF_LET(ACDF_F32, beyond) = (a - 0.5f) + (b - 0.5f); /* the equator */
    /* Exact near the poles, so that |b - a| <= r. */
    ACDF_LET(ACDF_F32, r) = ACDF_MAX(ACDF_MIN(a + b, (1.0f - a) + (1.0f - b)), 1e-30f);
    ACDF_LET(ACDF_F32, sine) = r * ACDF_SQRT(1.0f - 0.5f * r * r); /* over sqrt(2) */
    ACDF_LET(ACDF_F32, turn) = ACDF_RATIO(b - a, r) * 0.78539816f;
    ACDF_LET(ACDF_F32, s) = acdf_sine_float(turn);
    ACDF_LET(ACDF_F32, c) = acdf_cosine_float(turn);
    ACDF_VAR(AcdfVector, d);
    d.x = ACDF_FLOAT(ACDF_BITS(sine * (c - s)) ^ (ACDF_BITS(across) & 0x80000000u));
    d.y = ACDF_FLOAT(ACDF_BITS(sine * (c + s)) ^ (ACDF_BITS(along) & 0x80000000u));
    d.z = -beyond * (1.0f + r);
    return d;
}

/* The position in the square of a direction of nearly unit length that is not a pole: 1 - 2 u (`slope`) and
 * 2 v - 1 (`cap`). Keys are u and v in steps of 2^-24; sin2 and length2 are those of acdf_direction_keys. */
ACDF_FN5(AcdfDirectionKeys, acdf_square_keys, ACDF_F32, x, ACDF_F32, y, ACDF_F32, z, ACDF_F32, sin2, ACDF_F32,
         length2) {
    ACDF_LET(ACDF_F32, r) = ACDF_SQRT(acdf_cap_of(z, sin2, length2));
    ACDF_LET(ACDF_F32, ax) = ACDF_ABS(x);
    ACDF_LET(ACDF_F32, ay) = ACDF_ABS(y);
    ACDF_LET(ACDF_F32, ratio) = ACDF_RATIO(ACDF_MIN(ax, ay), ACDF_MAX(ax, ay));
    ACDF_LET(ACDF_F32, minor) = 0.63661977f * acdf_atan_float(ratio) * r;
    ACDF_LET(ACDF_F32, major) = r - minor;
    /* In the south folded over the diamond: the axis of the greater coordinate stays the greater one's. */
    ACDF_LET(ACDF_F32, more) = ACDF_SELECT(z < 0.0f, 1.0f - minor, major);
    ACDF_LET(ACDF_F32, less) = ACDF_SELECT(z < 0.0f, 1.0f - major, minor);
    ACDF_LET(ACDF_U32, a) = ACDF_BITS(ACDF_SELECT(ay > ax, less, more));
    ACDF_LET(ACDF_U32, b) = ACDF_BITS(ACDF_SELECT(ay > ax, more, less));
    ACDF_VAR(AcdfDirectionKeys, place);
    place.slope = ACDF_FLOAT(a | (ACDF_BITS(x) & 0x80000000u));
    place.cap = ACDF_FLOAT(b | (ACDF_BITS(y) & 0x80000000u));
    place.key0 = ACDF_TO_U32(ACDF_MIN((1.0f - place.slope) * ACDF_SQUARE_HALF, ACDF_SQUARE_LAST));
    place.key1 = ACDF_TO_U32(ACDF_MIN((1.0f + place.cap) * ACDF_SQUARE_HALF, ACDF_SQUARE_LAST));
    return place;
}

#ifdef __cplusplus
}
#endif
#endif
