/* What runtime tables compute: where in their grids a point lies, and pieces of the sphere. One text for processors
 * and for shaders of every language (acdf/dialect.h), in 32-bit words alone.
 *
 * The sphere is cut into eight pieces along z = 0 and the meridians half-way between the x and the y axes. In each,
 * azimuth is measured from the x or y axis in its middle: sine and cosine need no reduction, and minor over major
 * coordinate, in [-1, 1], orders directions by azimuth. Heights are measured from the nearer pole. */
#ifndef ACDF_PIECES_H
#define ACDF_PIECES_H

#include <acdf/dialect.h>

#ifdef __cplusplus
extern "C" {
#endif

/* ---- grids of blocks: acdf/squares.h ---------------------------------------------------------------- */

/* Words of an AcdfSquares. */
#define ACDF_SQUARES_SHIFT0 0u
#define ACDF_SQUARES_SHIFT1 1u
#define ACDF_SQUARES_BITS0 2u
#define ACDF_SQUARES_GRID 4u
#define ACDF_SQUARES_FINER_GRIDS 5u
#define ACDF_SQUARES_BOXES 6u
#define ACDF_SQUARES_CELLS 7u

/* An entry: shifts of both keys (5 bits each) and the number of a block; or the flag, and of a finer grid the bits
 * along key 0 (3 bits) and the number. */
#define ACDF_SQUARES_FINER 0x80000000u
#define ACDF_SQUARES_BLOCK_BITS 21u
#define ACDF_SQUARES_BLOCK_MASK 0x001FFFFFu
#define ACDF_FINER_BITS 4u

/* The entry of a point by the grids at word `squares`. */
ACDF_FN4(ACDF_U32, acdf_squares_entry, ACDF_TABLES, tables, ACDF_U32, squares, ACDF_U32, key0, ACDF_U32, key1) {
    ACDF_VAR(ACDF_U32, shift0) = ACDF_WORD(tables, squares + ACDF_SQUARES_SHIFT0);
    ACDF_VAR(ACDF_U32, shift1) = ACDF_WORD(tables, squares + ACDF_SQUARES_SHIFT1);
    ACDF_LET(ACDF_U32, row) = (key1 >> shift1) << ACDF_WORD(tables, squares + ACDF_SQUARES_BITS0);
    ACDF_VAR(ACDF_U32, entry) =
        ACDF_WORD(tables, ACDF_WORD(tables, squares + ACDF_SQUARES_GRID) + row + (key0 >> shift0));
    while ((entry & ACDF_SQUARES_FINER) != 0u) {
        ACDF_LET(ACDF_U32, bits0) = (entry >> 28u) & 7u;
        ACDF_LET(ACDF_U32, bits1) = ACDF_FINER_BITS - bits0;
        shift0 = shift0 - bits0;
        shift1 = shift1 - bits1;
        entry =
            ACDF_WORD(tables, ACDF_WORD(tables, squares + ACDF_SQUARES_FINER_GRIDS) + (entry & 0x0FFFFFFFu) * 16u +
                                  ((((key1 >> shift1) & ((1u << bits1) - 1u)) << bits0) |
                                   ((key0 >> shift0) & ((1u << bits0) - 1u))));
    }
    return entry;
}

/* Bit i: whether cell i of the block whose boxes stand at a word may hold the point; never of those that it lacks.
 */
ACDF_FN4(ACDF_U32, acdf_boxes_around, ACDF_TABLES, tables, ACDF_U32, boxes, ACDF_U32, byte0, ACDF_U32, byte1) {
    ACDF_VAR(ACDF_U32, mask) = 0u;
    ACDF_VAR(ACDF_U32, word) = 0u;
    for (word = 0u; word < 4u; word = word + 1u) { /* numbers less 128 become numbers again by their high bit */
        ACDF_LET(ACDF_U32, low0) = ACDF_WORD(tables, boxes + word) ^ 0x80808080u;
        ACDF_LET(ACDF_U32, high0) = ACDF_WORD(tables, boxes + word + 4u) ^ 0x80808080u;
        ACDF_LET(ACDF_U32, low1) = ACDF_WORD(tables, boxes + word + 8u) ^ 0x80808080u;
        ACDF_LET(ACDF_U32, high1) = ACDF_WORD(tables, boxes + word + 12u) ^ 0x80808080u;
        ACDF_VAR(ACDF_U32, shift) = 0u;
        for (shift = 0u; shift < 32u; shift = shift + 8u) {
            if (((low0 >> shift) & 0xFFu) <= byte0 && byte0 <= ((high0 >> shift) & 0xFFu) &&
                ((low1 >> shift) & 0xFFu) <= byte1 && byte1 <= ((high1 >> shift) & 0xFFu)) {
                mask = mask | (1u << (word * 4u + (shift >> 3u)));
            }
        }
    }
    return mask;
}

/* ---- drawing ---------------------------------------------------------------------------------------- */

/* Sine and cosine for |y| <= pi/4, interpolated at the Chebyshev nodes of y^2; error below 1e-7. */
ACDF_FN1(ACDF_F32, acdf_sine_float, ACDF_F32, y) {
    ACDF_LET(ACDF_F32, q) = y * y;
    return y + y * q * (-0.16666651f + q * (0.0083320351f + q * -0.00019503819f));
}
ACDF_FN1(ACDF_F32, acdf_cosine_float, ACDF_F32, y) {
    ACDF_LET(ACDF_F32, q) = y * y;
    return 1.0f + q * (-0.5f + q * (0.041666616f + q * (-0.0013886617f + q * 2.4379725e-5f)));
}

ACDF_STRUCT_BEGIN(AcdfVector)
ACDF_FIELD(ACDF_F32, x)
ACDF_FIELD(ACDF_F32, y)
ACDF_FIELD(ACDF_F32, z)
ACDF_STRUCT_END(AcdfVector)

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
ACDF_STRUCT_BEGIN(AcdfPlace)
ACDF_FIELD(ACDF_U32, key0)  /* quarter, then `slope` in steps of 2^-22 */
ACDF_FIELD(ACDF_U32, key1)  /* `cap` in steps of 2^-24, in the south all bits turned */
ACDF_FIELD(ACDF_F32, slope) /* minor over major coordinate, tangent of the local azimuth */
ACDF_FIELD(ACDF_F32, cap)   /* 1 - |z| */
ACDF_STRUCT_END(AcdfPlace)

#define ACDF_DIRECTION_BITS 25u
#define ACDF_DIRECTION_MASK 0x01FFFFFFu
#define ACDF_SLOPE_STEPS 4194304.0f
#define ACDF_CAP_STEPS 16777215.0f

/* Of a direction of nearly unit length that is not a pole; sin2 is x x + y y, length2 that and z z. */
ACDF_FN5(AcdfPlace, acdf_place_of, ACDF_F32, x, ACDF_F32, y, ACDF_F32, z, ACDF_F32, sin2, ACDF_F32, length2) {
    ACDF_LET(ACDF_U32, steep) = ACDF_SELECT(ACDF_ABS(y) > ACDF_ABS(x), 1u, 0u);
    ACDF_LET(ACDF_F32, minor) = ACDF_SELECT(steep != 0u, -x, y);
    ACDF_LET(ACDF_F32, major) = ACDF_SELECT(steep != 0u, y, x);
    ACDF_LET(ACDF_F32, cap) = sin2 * (2.0f - length2) / (1.0f + ACDF_ABS(z) * (1.5f - 0.5f * length2));
    ACDF_VAR(AcdfPlace, place);
    place.slope = ACDF_RATIO(minor, major);
    place.cap = ACDF_MIN(cap, 1.0f); /* exact near the poles */
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
