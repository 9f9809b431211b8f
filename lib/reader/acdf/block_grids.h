/* Where in the grids of acdf/squares.h a point lies, and which cells of a block may hold it. One text for
 * processors and for shaders of every language (acdf/dialect.h), in 32-bit words alone. */
#ifndef ACDF_BLOCK_GRIDS_H
#define ACDF_BLOCK_GRIDS_H

#include <acdf/dialect.h>

#ifdef __cplusplus
extern "C" {
#endif

/* ---- grids of blocks -------------------------------------------------------------------------------- */

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

/* The highest bit of each byte: whether that of a is at least that of b; bytes are signed. */
ACDF_FN2(ACDF_U32, acdf_bytes_reach, ACDF_U32, a, ACDF_U32, b) {
    ACDF_LET(ACDF_U32, difference) = (a | 0x80808080u) - (b & 0x7F7F7F7Fu);
    return ((~a) & b) | ((~(a ^ b)) & difference);
}
/* The same: whether each byte of a place lies from low to high. */
ACDF_FN3(ACDF_U32, acdf_bytes_within, ACDF_U32, place, ACDF_U32, low, ACDF_U32, high) {
    return acdf_bytes_reach(place, low) & acdf_bytes_reach(high, place);
}
/* These bits as the four lowest ones: no sum of the product carries. */
ACDF_FN1(ACDF_U32, acdf_four_bits, ACDF_U32, bytes) { return (((bytes >> 7u) & 0x01010101u) * 0x01020408u) >> 24u; }
/* A byte four times, less 128 as those of boxes are. */
ACDF_FN1(ACDF_U32, acdf_four_bytes, ACDF_U32, number) { return (number ^ 0x80u) * 0x01010101u; }

/* Bit i: whether cell i of the block whose boxes stand at a word may hold the point; never of those that it lacks.
 */
ACDF_FN4(ACDF_U32, acdf_boxes_around, ACDF_TABLES, tables, ACDF_U32, boxes, ACDF_U32, byte0, ACDF_U32, byte1) {
    ACDF_LET(ACDF_U32, place0) = acdf_four_bytes(byte0);
    ACDF_LET(ACDF_U32, place1) = acdf_four_bytes(byte1);
    ACDF_VAR(ACDF_U32, mask) = 0u;
    ACDF_VAR(ACDF_U32, word) = 0u;
    for (word = 0u; word < 4u; word = word + 1u) {
        ACDF_LET(ACDF_U32, within0) =
            acdf_bytes_within(place0, ACDF_WORD(tables, boxes + word), ACDF_WORD(tables, boxes + word + 4u));
        ACDF_LET(ACDF_U32, within1) =
            acdf_bytes_within(place1, ACDF_WORD(tables, boxes + word + 8u), ACDF_WORD(tables, boxes + word + 12u));
        mask = mask | (acdf_four_bits(within0 & within1) << (word * 4u));
    }
    return mask;
}

#ifdef __cplusplus
}
#endif
#endif
