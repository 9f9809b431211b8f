/* Draws and densities of an environment for shaders: 32-bit words and floats alone, no walk of a tree, an answer
 * for every number and every direction. `acdf export` writes this text in the languages of shaders (lib/shader);
 * here it is C, over the words that acdf::ShaderTables (acdf/shader_tables.h) makes.
 *
 * Where runtime tables (acdf/cells.h) answer, so do these, with the same direction and the same density to the bit
 * - where the language rounds as IEEE 754 does, and a cell has more than some ten numbers of 2^-31. Elsewhere,
 * where the reader walks the tree: a draw is moved inwards, by 2^-20 radians, 2^-20 of its cell's numbers or three
 * steps of 2^-31, whichever is the most; the density of a direction within 2^-20 radians of a border may be the
 * neighbour's. A draw has always the density that is told of its direction. */
#ifndef ACDF_SHADER_H
#define ACDF_SHADER_H

#include <acdf/block_grids.h>
#include <acdf/pieces.h>

#ifdef __cplusplus
extern "C" {
#endif

/* Words of an AcdfCells. */
#define ACDF_CELLS_NUMBERS 2u
#define ACDF_CELLS_DIRECTIONS 11u
#define ACDF_CELLS_PIECES 20u
#define ACDF_CELLS_DENSITIES 21u
#define ACDF_CELLS_ENDS 22u
/* Words of a piece (AcdfPiece), and of its ends (AcdfPieceEnds). */
#define ACDF_PIECE_WORDS 8u
#define ACDF_ENDS_WORDS 8u

/* What is drawn. */
ACDF_STRUCT_BEGIN(AcdfShaderSample)
ACDF_FIELD(ACDF_F32, x) /* a unit direction, towards the light; right-handed, z up */
ACDF_FIELD(ACDF_F32, y)
ACDF_FIELD(ACDF_F32, z)
ACDF_FIELD(ACDF_F32, pdf) /* sr^-1 */
ACDF_STRUCT_END(AcdfShaderSample)

/* Float i of the array that begins at the word which stands at a place. */
ACDF_FN3(ACDF_F32, acdf_word_float, ACDF_TABLES, tables, ACDF_U32, place, ACDF_U32, i) {
    return ACDF_FLOAT(ACDF_WORD(tables, ACDF_WORD(tables, place) + i));
}

/* The mask of the cells in the block of an entry that may hold a point. */
ACDF_FN5(ACDF_U32, acdf_block_mask, ACDF_TABLES, tables, ACDF_U32, squares, ACDF_U32, entry, ACDF_U32, key0,
         ACDF_U32, key1) {
    ACDF_LET(ACDF_U32, boxes) =
        ACDF_WORD(tables, squares + ACDF_SQUARES_BOXES) + 16u * (entry & ACDF_SQUARES_BLOCK_MASK);
    return acdf_boxes_around(tables, boxes, (key0 >> (entry >> 26u)) & 0xFFu,
                             (key1 >> ((entry >> 21u) & 31u)) & 0xFFu);
}

/* Which cell the lowest bit of a mask stands for. */
ACDF_FN4(ACDF_U32, acdf_block_cell, ACDF_TABLES, tables, ACDF_U32, squares, ACDF_U32, entry, ACDF_U32, mask) {
    ACDF_LET(ACDF_U32, bit) = (ACDF_BITS(ACDF_TO_F32(mask & (0u - mask))) >> 23u) - 127u; /* by its exponent */
    ACDF_LET(ACDF_U32, two) = ACDF_WORD(tables, ACDF_WORD(tables, squares + ACDF_SQUARES_CELLS) +
                                                    8u * (entry & ACDF_SQUARES_BLOCK_MASK) + (bit >> 1u));
    return (two >> ((bit & 1u) << 4u)) & 0xFFFFu;
}

/* How far a number (a 32nd bit more than `low` has) is from `low`, in steps of 2^-52. */
ACDF_FN3(ACDF_F32, acdf_number_distance, ACDF_U32, number, ACDF_U32, low, ACDF_F32, sign) {
    ACDF_LET(ACDF_U32, start) = low << 1u;
    ACDF_LET(ACDF_F32, up) = ACDF_SELECT(number < start, -ACDF_TO_F32(start - number), ACDF_TO_F32(number - start));
    return ACDF_SELECT(up * sign > 0.0f, up * 1048576.0f, 0.0f);
}

/* Local azimuth or height at a number, by the axis of a piece at a word; sign: -1 where numbers count down from
 * `low`. */
ACDF_FN4(ACDF_F32, acdf_along_axis, ACDF_TABLES, tables, ACDF_U32, axis, ACDF_U32, number, ACDF_F32, sign) {
    ACDF_LET(ACDF_F32, width) = ACDF_FLOAT(ACDF_WORD(tables, axis + 1u));
    ACDF_LET(ACDF_F32, d) = acdf_number_distance(number, ACDF_WORD(tables, axis), sign);
    ACDF_LET(ACDF_F32, inside) = ACDF_SELECT(d * sign < width, d, width * sign);
    return ACDF_FLOAT(ACDF_WORD(tables, axis + 2u)) + inside * ACDF_FLOAT(ACDF_WORD(tables, axis + 3u));
}

/* What a cell's piece draws for two numbers that lead into it. */
ACDF_FN4(AcdfShaderSample, acdf_draw_in_piece, ACDF_TABLES, tables, ACDF_U32, cell, ACDF_U32, n0, ACDF_U32, n1) {
    ACDF_LET(ACDF_U32, piece) = ACDF_WORD(tables, ACDF_CELLS_PIECES) + ACDF_PIECE_WORDS * cell;
    ACDF_LET(ACDF_U32, south) = ACDF_WORD(tables, piece + 5u) & 1u;
    ACDF_LET(AcdfVector, d) =
        acdf_piece_direction(acdf_along_axis(tables, piece, n0, 1.0f),
                             acdf_along_axis(tables, piece + 4u, n1, ACDF_SELECT(south != 0u, -1.0f, 1.0f)),
                             ACDF_WORD(tables, piece + 1u) & 3u, south);
    ACDF_VAR(AcdfShaderSample, drawn);
    drawn.x = d.x;
    drawn.y = d.y;
    drawn.z = d.z;
    drawn.pdf = acdf_word_float(tables, ACDF_CELLS_DENSITIES, cell);
    return drawn;
}

/* Draws a direction for two random words: n0 / 2^32 (azimuth) and n1 / 2^32 (elevation) are the random numbers of
 * acdf_environment_sample. Monotone in each of them within a segment. */
ACDF_FN3(AcdfShaderSample, acdf_shader_sample, ACDF_TABLES, tables, ACDF_U32, n0, ACDF_U32, n1) {
    ACDF_LET(ACDF_U32, key0) = n0 >> 1u;
    ACDF_LET(ACDF_U32, key1) = n1 >> 1u;
    ACDF_LET(ACDF_U32, entry) = acdf_squares_entry(tables, ACDF_CELLS_NUMBERS, key0, key1);
    ACDF_VAR(ACDF_U32, mask) = acdf_block_mask(tables, ACDF_CELLS_NUMBERS, entry, key0, key1);
    ACDF_VAR(ACDF_U32, cell) = 0u;
    while (mask != 0u) { /* one cell at least holds the numbers; the last is taken without a look */
        cell = acdf_block_cell(tables, ACDF_CELLS_NUMBERS, entry, mask);
        mask = mask & (mask - 1u);
        if (mask != 0u) {
            ACDF_LET(ACDF_U32, ends) = ACDF_WORD(tables, ACDF_CELLS_ENDS) + ACDF_ENDS_WORDS * cell;
            if (key0 - ACDF_WORD(tables, ends) < ACDF_WORD(tables, ends + 1u) &&
                key1 - ACDF_WORD(tables, ends + 2u) < ACDF_WORD(tables, ends + 3u)) {
                mask = 0u;
            }
        }
    }
    return acdf_draw_in_piece(tables, cell, n0, n1);
}

/* Density per steradian with which acdf_shader_sample draws a direction (unit). 0 where none falls, and for
 * directions whose length differs from 1 by more than 5e-4 or that are not finite. */
ACDF_FN4(ACDF_F32, acdf_shader_pdf, ACDF_TABLES, tables, ACDF_F32, x, ACDF_F32, y, ACDF_F32, z) {
    ACDF_LET(AcdfUnit, d) = acdf_unit_of(x, y, z);
    if (d.length2 == 0.0f) {
        return 0.0f;
    }
    ACDF_LET(AcdfPlace, place) = acdf_place_of(d.x, d.y, d.z, d.sin2, d.length2);
    ACDF_LET(ACDF_F32, slope) = ACDF_SELECT(place.slope < 1.0f, place.slope, -1.0f); /* the next quarter's */
    ACDF_LET(ACDF_U32, entry) = acdf_squares_entry(tables, ACDF_CELLS_DIRECTIONS, place.key0, place.key1);
    ACDF_VAR(ACDF_U32, mask) = acdf_block_mask(tables, ACDF_CELLS_DIRECTIONS, entry, place.key0, place.key1);
    ACDF_VAR(ACDF_U32, cell) = 0u;
    while (mask != 0u) {
        cell = acdf_block_cell(tables, ACDF_CELLS_DIRECTIONS, entry, mask);
        mask = mask & (mask - 1u);
        if (mask != 0u) {
            ACDF_LET(ACDF_U32, ends) = ACDF_ENDS_WORDS * cell + 4u;
            if (slope >= acdf_word_float(tables, ACDF_CELLS_ENDS, ends) &&
                slope < acdf_word_float(tables, ACDF_CELLS_ENDS, ends + 1u) &&
                place.cap >= acdf_word_float(tables, ACDF_CELLS_ENDS, ends + 2u) &&
                place.cap < acdf_word_float(tables, ACDF_CELLS_ENDS, ends + 3u)) {
                mask = 0u;
            }
        }
    }
    return acdf_word_float(tables, ACDF_CELLS_DENSITIES, cell);
}

#ifdef __cplusplus
}
#endif
#endif
