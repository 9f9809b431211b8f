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

#ifdef __cplusplus
}
#endif
#endif
