/* Pieces of the sphere, in which directions are sampled and found in floats. One text for processors and for
 * shaders of every language (acdf/shader/dialect.h).
 *
 * The sphere is cut into eight pieces along z = 0 and the meridians half-way between the x and the y axes. In each,
 * azimuth is measured from the x or y axis in its middle: sine and cosine need no reduction, and minor over major
 * coordinate, in [-1, 1], orders directions by azimuth. Heights are measured from the nearer pole. */
#ifndef ACDF_SHADER_PIECES_H
#define ACDF_SHADER_PIECES_H

#include <acdf/shader/dialect.h>

#include <acdf/angle_float.h>

#ifdef __cplusplus
extern "C" {
#endif

/* ---- sampling ---------------------------------------------------------------------------------------- */

/* The word of a random number in [0, 1] (others are clamped, NaN counts as 0): its first 32 bits. */
ACDF_FN1(ACDF_U32, acdf_number, ACDF_F32, u) {
    ACDF_LET(ACDF_F32, from_zero) = ACDF_SELECT(u > 0.0f, u, 0.0f);
    ACDF_LET(ACDF_F32, high) = ACDF_MIN(from_zero, 0.99999994f) * 65536.0f;
    ACDF_LET(ACDF_U32, bits) = ACDF_TO_U32(high);
    return (bits << 16u) | ACDF_TO_U32((high - ACDF_TO_F32(bits)) * 65536.0f);
}

ACDF_STRUCT_BEGIN(AcdfVector)
ACDF_FIELD(ACDF_F32, x)
ACDF_FIELD(ACDF_F32, y)
ACDF_FIELD(ACDF_F32, z)
ACDF_STRUCT_END(AcdfVector)

ACDF_FN3(AcdfVector, acdf_vector, ACDF_F32, x, ACDF_F32, y, ACDF_F32, z) {
    ACDF_VAR(AcdfVector, d);
    d.x = x;
    d.y = y;
    d.z = z;
    return d;
}

/* The direction at a local azimuth in a quarter (0: around +x, then +y, -x, -y) and 1 - |z|; south: 0 or 1. */
ACDF_FN4(AcdfVector, acdf_piece_direction, ACDF_F32, azimuth, ACDF_F32, cap, ACDF_U32, quarter, ACDF_U32, south) {
    ACDF_LET(ACDF_F32, radius) = ACDF_SQRT(cap * (2.0f - cap)); /* exact near the poles, where z is not */
    ACDF_LET(ACDF_U32, major) = ACDF_BITS(radius * acdf_cosine_float(azimuth));
    ACDF_LET(ACDF_U32, minor) = ACDF_BITS(radius * acdf_sine_float(azimuth));
    ACDF_LET(ACDF_U32, swapped) = (major ^ minor) & (0u - (quarter & 1u));
    ACDF_VAR(AcdfVector, d);
    d.x = ACDF_FLOAT((major ^ swapped) ^ (((quarter + 1u) & 2u) << 30u));
    d.y = ACDF_FLOAT((minor ^ swapped) ^ ((quarter & 2u) << 30u));
    d.z = ACDF_FLOAT(ACDF_BITS(1.0f - cap) ^ (south << 31u));
    return d;
}

/* ---- finding ---------------------------------------------------------------------------------------- */

/* A direction as pieces see it. */
ACDF_STRUCT_BEGIN(AcdfDirectionKeys)
ACDF_FIELD(ACDF_U32, key0)  /* quarter, then `slope` in steps of 2^-22 */
ACDF_FIELD(ACDF_U32, key1)  /* `cap` in steps of 2^-24, in the south all bits turned */
ACDF_FIELD(ACDF_F32, slope) /* minor over major coordinate, tangent of the local azimuth */
ACDF_FIELD(ACDF_F32, cap)   /* 1 - |z| */
ACDF_STRUCT_END(AcdfDirectionKeys)

/* A direction as the lookups take it. */
ACDF_STRUCT_BEGIN(AcdfUnit)
ACDF_FIELD(ACDF_F32, x) /* of a pole, whose azimuth is all one, 1e-18 */
ACDF_FIELD(ACDF_F32, y)
ACDF_FIELD(ACDF_F32, z)
ACDF_FIELD(ACDF_F32, sin2)    /* x x + y y */
ACDF_FIELD(ACDF_F32, length2) /* of the direction; 0: it differs from 1 by more than 1e-3, or is not finite */
ACDF_STRUCT_END(AcdfUnit)

ACDF_FN3(AcdfUnit, acdf_unit_of, ACDF_F32, x, ACDF_F32, y, ACDF_F32, z) {
    ACDF_LET(ACDF_U32, pole) = ACDF_SELECT(ACDF_ABS(x) + ACDF_ABS(y) < 1e-18f, 1u, 0u);
    ACDF_VAR(AcdfUnit, d);
    d.x = ACDF_SELECT(pole != 0u, 1e-18f, x);
    d.y = ACDF_SELECT(pole != 0u, 0.0f, y);
    d.z = z;
    d.sin2 = d.x * d.x + d.y * d.y;
    d.length2 = d.sin2 + z * z;
    if (ACDF_BITS(d.length2) - 0x3F7FBE7Bu > 0x0000624Cu) { /* 0.9995^2 to 1.0005^2, by their bits */
        d.length2 = 0.0f;
    }
    return d;
}

#define ACDF_DIRECTION_BITS 25u
#define ACDF_DIRECTION_MASK 0x01FFFFFFu
#define ACDF_SLOPE_STEPS 4194304.0f
#define ACDF_CAP_STEPS 16777215.0f

/* 1 - |z| of a direction of nearly unit length, exact near the poles; sin2 is x x + y y, length2 that and z z. */
ACDF_FN3(ACDF_F32, acdf_cap_of, ACDF_F32, z, ACDF_F32, sin2, ACDF_F32, length2) {
    ACDF_LET(ACDF_F32, cap) = sin2 * (2.0f - length2) / (1.0f + ACDF_ABS(z) * (1.5f - 0.5f * length2));
    return ACDF_MIN(cap, 1.0f);
}

/* Of a direction of nearly unit length that is not a pole; sin2 is x x + y y, length2 that and z z. */
ACDF_FN5(AcdfDirectionKeys, acdf_direction_keys, ACDF_F32, x, ACDF_F32, y, ACDF_F32, z, ACDF_F32, sin2, ACDF_F32,
         length2) {
    ACDF_LET(ACDF_U32, steep) = ACDF_SELECT(ACDF_ABS(y) > ACDF_ABS(x), 1u, 0u);
    ACDF_LET(ACDF_F32, minor) = ACDF_SELECT(steep != 0u, -x, y);
    ACDF_LET(ACDF_F32, major) = ACDF_SELECT(steep != 0u, y, x);
    ACDF_VAR(AcdfDirectionKeys, place);
    place.slope = ACDF_RATIO(minor, major);
    place.cap = acdf_cap_of(z, sin2, length2);
    place.key0 = ((steep | ((ACDF_BITS(major) >> 30u) & 2u)) << 23u) +
                 ACDF_TO_U32(place.slope * ACDF_SLOPE_STEPS + ACDF_SLOPE_STEPS);
    place.key0 = place.key0 & ACDF_DIRECTION_MASK; /* the last quarter's end is the first one's beginning */
    place.key1 = (ACDF_TO_U32(place.cap * ACDF_CAP_STEPS) ^ (0u - (ACDF_BITS(z) >> 31u))) & ACDF_DIRECTION_MASK;
    return place;
}

#ifdef __cplusplus
}
#endif
#endif
