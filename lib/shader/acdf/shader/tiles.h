/* Local environments of the fast shape (acdf/fast.h) for shaders: rows of cumulative sums over tiles, and a regular
 * grid of cells in each tile, as they lie in the file; over the words that acdf::ShaderTables::make_walk
 * (acdf/shader/tables.h) makes. One text for processors and for shaders of every language (acdf/dialect.h).
 *
 * Weights of rows and sums are whole numbers, as the reader has them. A list of sums is halved until one is left,
 * as trees are traversed (acdf/shader/tree.h): random numbers are rescaled exactly, and borders are where
 * floats put them. */
#ifndef ACDF_SHADER_TILES_H
#define ACDF_SHADER_TILES_H

#include <acdf/shader/point.h>

#ifdef __cplusplus
extern "C" {
#endif

/* ---- tables of the fast shape ----------------------------------------------------------------------- */

/* Words of its header, which follows that of acdf/shader/tree.h. Offsets are words from the start of the tables.
 */
#define ACDF_TILES_COLUMNS 32u /* of the grid of directions */
#define ACDF_TILES_ROWS 33u
#define ACDF_TILES_GROUPS 34u /* of 16 tiles */
#define ACDF_TILES_ENDS 35u   /* how many sums of groups a row has */
#define ACDF_TILES_ROOT 36u   /* split where traversals begin, or the only tile */
#define ACDF_TILES_SPLITS                                                                                          \
    37u                        /* 2 words each: axis (three bits) and position; 16 bits each: lower and upper part \
                                */
#define ACDF_TILES_RECORDS 38u /* 4 words a tile (acdf_tiles_record) */
#define ACDF_TILES_SUMS 39u    /* 16 bits a sum of groups */
#define ACDF_TILES_INNER 40u   /* 8 bits a sum of the tiles of a group */
#define ACDF_TILES_GRIDS 41u   /* 8 bits a sum of lines, and of the cells of each */
#define ACDF_TILES_SINES                                                                                           \
    42u /* f32: sin(pi i / (2 rows)), i = 0 to 2 rows; of the octahedral square there are none */
#define ACDF_TILES_END 43u

#define ACDF_TILES_FLAG 0x8000u /* of a part of a split: it is a tile */
#define ACDF_TILES_INSIDE                                                                                          \
    9.536743e-7f /* samples stay 2^-20 inside their cell: radians, or parts of the square's side */

/* ---- sums ------------------------------------------------------------------------------------------- */

/* Up to three lists of cumulative numbers, which are mixed. */
ACDF_STRUCT_BEGIN(AcdfTileSums)
ACDF_FIELD(ACDF_U32, word)   /* numbers are counted from it on */
ACDF_FIELD(ACDF_U32, wide)   /* 1: they have 16 bits, 0: 8 */
ACDF_FIELD(ACDF_U32, first0) /* the first number of each list */
ACDF_FIELD(ACDF_U32, first1)
ACDF_FIELD(ACDF_U32, first2)
ACDF_FIELD(ACDF_U32, weight0) /* 0: there is no such list */
ACDF_FIELD(ACDF_U32, weight1)
ACDF_FIELD(ACDF_U32, weight2)
ACDF_STRUCT_END(AcdfTileSums)

/* Number i of those from a word on. */
ACDF_FN4(ACDF_U32, acdf_tiles_number, ACDF_TABLES, tables, ACDF_U32, word, ACDF_U32, wide, ACDF_U32, i) {
    ACDF_LET(ACDF_U32, several) = ACDF_WORD(tables, word + (i >> (2u - wide)));
    ACDF_LET(ACDF_U32, shifted) = several >> ((i << (3u + wide)) & 31u);
    return ACDF_SELECT(wide != 0u, shifted & 0xFFFFu, shifted & 0xFFu);
}

/* What a list holds before its number i: it begins at number `first`. */
ACDF_FN5(ACDF_U32, acdf_tiles_below, ACDF_TABLES, tables, ACDF_U32, word, ACDF_U32, wide, ACDF_U32, first, ACDF_U32,
         i) {
    ACDF_LET(ACDF_U32, sum) = acdf_tiles_number(tables, word, wide, first + ACDF_MAX(i, 1u) - 1u);
    return ACDF_SELECT(i > 0u, sum, 0u);
}

/* What it holds in its number i. */
ACDF_FN5(ACDF_U32, acdf_tiles_inside, ACDF_TABLES, tables, ACDF_U32, word, ACDF_U32, wide, ACDF_U32, first,
         ACDF_U32, i) {
    return acdf_tiles_number(tables, word, wide, first + i) - acdf_tiles_below(tables, word, wide, first, i);
}

/* One list of bytes, by itself. */
ACDF_FN2(AcdfTileSums, acdf_tiles_list, ACDF_U32, word, ACDF_U32, first) {
    ACDF_VAR(AcdfTileSums, sums);
    sums.word = word;
    sums.wide = 0u;
    sums.first0 = first;
    sums.first1 = first;
    sums.first2 = first;
    sums.weight0 = 1u;
    sums.weight1 = 0u;
    sums.weight2 = 0u;
    return sums;
}

/* What is mixed, in all. */
ACDF_FN1(ACDF_U32, acdf_tiles_whole, AcdfTileSums, sums) {
    return (sums.weight0 + sums.weight1 + sums.weight2) * ACDF_SELECT(sums.wide != 0u, 32767u, 255u);
}

/* Which number was sampled, and the random number rescaled to [0, 1]. */
ACDF_STRUCT_BEGIN(AcdfTileSample)
ACDF_FIELD(ACDF_U32, i)
ACDF_FIELD(ACDF_U32, at)
ACDF_FIELD(ACDF_U32, width)
ACDF_STRUCT_END(AcdfTileSample)

/* The first one, of a random number of which nothing was used. */
ACDF_FN2(AcdfTileSample, acdf_tiles_chosen, ACDF_U32, at, ACDF_U32, width) {
    ACDF_VAR(AcdfTileSample, sampled);
    sampled.i = 0u;
    sampled.at = at;
    sampled.width = width;
    return sampled;
}

/* One of `count` from the first one on. */
ACDF_FN4(AcdfTileSample, acdf_tiles_choose, ACDF_TABLES, tables, AcdfTileSums, sums, ACDF_U32, count,
         AcdfTileSample, first) {
    ACDF_VAR(AcdfTileSample, sampled) = first;
    ACDF_VAR(ACDF_U32, last) = count;
    ACDF_VAR(ACDF_U32, low) = 0u;
    ACDF_VAR(ACDF_U32, high) = acdf_tiles_whole(sums);
    while (sampled.i + 1u < last) {
        ACDF_LET(ACDF_U32, middle) = (sampled.i + last) >> 1u;
        ACDF_LET(ACDF_U32, sum) =
            sums.weight0 * acdf_tiles_number(tables, sums.word, sums.wide, sums.first0 + middle - 1u) +
            sums.weight1 * acdf_tiles_number(tables, sums.word, sums.wide, sums.first1 + middle - 1u) +
            sums.weight2 * acdf_tiles_number(tables, sums.word, sums.wide, sums.first2 + middle - 1u);
        ACDF_LET(ACDF_U32, border) =
            acdf_walk_border(ACDF_TO_F32(sum - low), ACDF_TO_F32(high - sum), sampled.width);
        if (sampled.at < border) {
            last = middle;
            high = sum;
            sampled.width = border;
        } else {
            sampled.i = middle;
            low = sum;
            sampled.at = sampled.at - border;
            sampled.width = sampled.width - border;
        }
    }
    return sampled;
}

/* ---- rows ------------------------------------------------------------------------------------------- */

/* The weight of a row in a scale: at most 2^14, and 0 only of none. */
ACDF_FN2(ACDF_U32, acdf_tiles_weight, ACDF_F32, weight, ACDF_F32, scale) {
    return ACDF_SELECT(weight > 0.0f, ACDF_TO_U32(weight * scale) + 1u, 0u);
}

/* The groups of tiles as a mixture has them: acdf_fast_mix. */
ACDF_FN2(AcdfTileSums, acdf_tiles_groups, ACDF_TABLES, tables, AcdfWalkMixture, mix) {
    ACDF_LET(ACDF_U32, ends) = ACDF_WORD(tables, ACDF_TILES_ENDS);
    ACDF_LET(ACDF_F32, whole) = mix.weight0 + mix.weight1 + mix.weight2;
    /* The power of two that takes it to between 2^13 and 2^14. */
    ACDF_LET(ACDF_F32, scale) = ACDF_FLOAT(ACDF_MIN(267u - (ACDF_BITS(whole) >> 23u), 254u) << 23u);
    ACDF_VAR(AcdfTileSums, sums);
    sums.word = ACDF_WORD(tables, ACDF_TILES_SUMS);
    sums.wide = 1u;
    sums.first0 = mix.row0 * ends;
    sums.first1 = mix.row1 * ends;
    sums.first2 = mix.row2 * ends;
    sums.weight0 = acdf_tiles_weight(mix.weight0, scale);
    sums.weight1 = acdf_tiles_weight(mix.weight1, scale);
    sums.weight2 = acdf_tiles_weight(mix.weight2, scale);
    return sums;
}

/* A group: its tiles, and what it has of the mixture. */
ACDF_STRUCT_BEGIN(AcdfTileGroup)
ACDF_FIELD(AcdfTileSums, sums)
ACDF_FIELD(ACDF_U32, mass) /* below 2^30 */
ACDF_STRUCT_END(AcdfTileGroup)

/* Group i, in which rows weigh what they give to it, in 14 bits: acdf_fast_find_group. */
ACDF_FN4(AcdfTileGroup, acdf_tiles_group, ACDF_TABLES, tables, AcdfWalkMixture, mix, AcdfTileSums, groups, ACDF_U32,
         i) {
    ACDF_LET(ACDF_U32, stride) = 16u * ACDF_WORD(tables, ACDF_TILES_GROUPS);
    ACDF_LET(ACDF_U32, given0) = groups.weight0 * acdf_tiles_inside(tables, groups.word, 1u, groups.first0, i);
    ACDF_LET(ACDF_U32, given1) = groups.weight1 * acdf_tiles_inside(tables, groups.word, 1u, groups.first1, i);
    ACDF_LET(ACDF_U32, given2) = groups.weight2 * acdf_tiles_inside(tables, groups.word, 1u, groups.first2, i);
    ACDF_VAR(AcdfTileGroup, group);
    group.mass = given0 + given1 + given2;
    /* By how many bits it is longer than 14. */
    ACDF_LET(ACDF_U32, longer) = ACDF_BITS(ACDF_TO_F32(group.mass >> 14u)) >> 23u;
    ACDF_LET(ACDF_U32, shift) = ACDF_MAX(longer, 126u) - 126u;
    ACDF_LET(ACDF_U32, most) = (1u << shift) - 1u;
    group.sums.word = ACDF_WORD(tables, ACDF_TILES_INNER);
    group.sums.wide = 0u;
    group.sums.first0 = mix.row0 * stride + 16u * i;
    group.sums.first1 = mix.row1 * stride + 16u * i;
    group.sums.first2 = mix.row2 * stride + 16u * i;
    group.sums.weight0 = (given0 + most) >> shift;
    group.sums.weight1 = (given1 + most) >> shift;
    group.sums.weight2 = (given2 + most) >> shift;
    return group;
}

/* What of a mixture a tile has. */
ACDF_FN3(ACDF_F32, acdf_tiles_share, ACDF_TABLES, tables, AcdfWalkMixture, mix, ACDF_U32, tile) {
    ACDF_LET(AcdfTileSums, groups) = acdf_tiles_groups(tables, mix);
    ACDF_LET(AcdfTileGroup, group) = acdf_tiles_group(tables, mix, groups, tile >> 4u);
    ACDF_LET(AcdfTileSums, sums) = group.sums;
    ACDF_LET(ACDF_U32, i) = tile & 15u;
    ACDF_LET(ACDF_U32, inner) = sums.weight0 * acdf_tiles_inside(tables, sums.word, 0u, sums.first0, i) +
                                sums.weight1 * acdf_tiles_inside(tables, sums.word, 0u, sums.first1, i) +
                                sums.weight2 * acdf_tiles_inside(tables, sums.word, 0u, sums.first2, i);
    /* Nothing is given to a group without weights. */
    return ACDF_TO_F32(group.mass) / ACDF_TO_F32(ACDF_MAX(acdf_tiles_whole(groups), 1u)) *
           (ACDF_TO_F32(inner) / ACDF_TO_F32(ACDF_MAX(acdf_tiles_whole(sums), 1u)));
}

#ifdef __cplusplus
}
#endif
#endif
