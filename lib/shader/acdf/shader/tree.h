/* Trees for shaders: mixtures of rows, and traversals by random numbers or by the keys of a direction, over the
 * words that acdf::ShaderTables::make_walk (acdf/shader/tables.h) makes. 32-bit words and floats alone. One text
 * for processors and for shaders of every language (acdf/shader/dialect.h).
 *
 * A tree of splits ends in leaves. A split is known by its key, which directions have too, so that one tree serves
 * samples and pdfs, and both multiply the same factors in the same order. Random numbers are whole, and splits
 * leave an exact rest of them. A cell of probability p is sampled with p but for 2^-24 of it a split, since floats
 * round the borders. */
#ifndef ACDF_SHADER_TREE_H
#define ACDF_SHADER_TREE_H

#include <acdf/shader/octahedral_float.h>

#ifdef __cplusplus
extern "C" {
#endif

/* ---- tables ----------------------------------------------------------------------------------------- */

/* Words of the header; `link` is a node, or a leaf with its flag. Offsets are words from the start of the
 * tables. */
#define ACDF_WALK_SIZE 0u        /* of all, in words */
#define ACDF_WALK_OCTAHEDRAL 1u  /* 1: positions lie on the octahedral square, 0: on a lat-long grid */
#define ACDF_WALK_ENVIRONMENT 2u /* link of the tree of all normals */
#define ACDF_WALK_MIXTURE 3u     /* link of what bins share; ACDF_WALK_NONE: there are no bins */
#define ACDF_WALK_NODES 4u  /* 4 words each: axis (bit 31) and key, link of the lower part, of the upper, chance */
#define ACDF_WALK_LEAVES 5u /* ACDF_LEAF_WORDS each */
#define ACDF_WALK_SUBDIVISIONS 6u /* of the octahedron of normals */
#define ACDF_WALK_BINS 9u         /* 2 words each: row and share, f32 */
#define ACDF_WALK_BIN_COUNT 10u   /* 0: the file stores no normals */
/* f32, `stride` of them a row: the smaller of the parts that a split gives to its halves; negative: to the upper.
 */
#define ACDF_WALK_SHARES 12u
#define ACDF_WALK_STRIDE 13u
#define ACDF_WALK_COSINE 16u     /* f32: share of a cosine lobe about the normal */
#define ACDF_WALK_VIEWS 17u      /* of BRDFs, 4 words each (acdf/shader/brdf.h) */
#define ACDF_WALK_VIEW_COUNT 18u /* elevations */
#define ACDF_WALK_AZIMUTHS 19u   /* of each of them; bins are numbered elevation by elevation; 0: no BRDF */
#define ACDF_WALK_MIRRORED 20u   /* 1: azimuths of half-vectors are folded */
#define ACDF_WALK_MAPS 21u       /* of several maps (acdf/shader/maps.h); 0: there are none */
#define ACDF_WALK_ZERO 31u       /* is 0, which no compiler knows */
#define ACDF_WALK_HEADER_WORDS 32u

#define ACDF_WALK_NONE 0xFFFFFFFFu
#define ACDF_WALK_LEAF 0x80000000u /* of a link: it is a leaf */
#define ACDF_WALK_SPLIT                                                                                            \
    0x40000000u /* of a node's chance: rows store it, as their code of the split of that number */

/* Word i as a float. */
ACDF_FN2(ACDF_F32, acdf_word_as_float, ACDF_TABLES, tables, ACDF_U32, i) {
    return ACDF_FLOAT(ACDF_WORD(tables, i));
}

/* ---- mixtures --------------------------------------------------------------------------------------- */

/* The mixture that is searched below a link: up to four rows side by side. */
ACDF_STRUCT_BEGIN(AcdfWalkMixture)
ACDF_FIELD(ACDF_U32, root) /* where traversals begin; ACDF_WALK_NONE: there is nothing */
ACDF_FIELD(ACDF_U32, row0)
ACDF_FIELD(ACDF_U32, row1)
ACDF_FIELD(ACDF_U32, row2)
ACDF_FIELD(ACDF_U32, row3)
ACDF_FIELD(ACDF_F32, weight0) /* rows without weight are the last ones */
ACDF_FIELD(ACDF_F32, weight1)
ACDF_FIELD(ACDF_F32, weight2)
ACDF_FIELD(ACDF_F32, weight3)
ACDF_STRUCT_END(AcdfWalkMixture)

/* A tree that no row divides has one weight, 1. */
ACDF_FN2(AcdfWalkMixture, acdf_mixture_below, ACDF_U32, root, ACDF_F32, weight) {
    ACDF_VAR(AcdfWalkMixture, mix);
    mix.root = root;
    mix.row0 = 0u;
    mix.row1 = 0u;
    mix.row2 = 0u;
    mix.row3 = 0u;
    mix.weight0 = weight;
    mix.weight1 = 0.0f;
    mix.weight2 = 0.0f;
    mix.weight3 = 0.0f;
    return mix;
}

/* The sum of the weights. */
ACDF_FN1(ACDF_F32, acdf_mixture_weight, AcdfWalkMixture, mix) {
    return mix.weight0 + mix.weight1 + mix.weight2 + mix.weight3;
}

/* Adds a row, unless its weight is 0. */
ACDF_FN3(AcdfWalkMixture, acdf_mixture_with, AcdfWalkMixture, given, ACDF_U32, row, ACDF_F32, weight) {
    ACDF_VAR(AcdfWalkMixture, mix) = given;
    if (!(weight > 0.0f)) {
        return mix;
    }
    if (mix.weight0 == 0.0f) {
        mix.row0 = row;
        mix.weight0 = weight;
    } else if (mix.weight1 == 0.0f) {
        mix.row1 = row;
        mix.weight1 = weight;
    } else if (mix.weight2 == 0.0f) {
        mix.row2 = row;
        mix.weight2 = weight;
    } else {
        mix.row3 = row;
        mix.weight3 = weight;
    }
    return mix;
}

/* What a row gives to the lower part of a split (0) or to the upper one (1). */
ACDF_FN4(ACDF_F32, acdf_walk_share, ACDF_TABLES, tables, ACDF_U32, row, ACDF_U32, split, ACDF_U32, side) {
    ACDF_LET(ACDF_U32, at) =
        ACDF_WORD(tables, ACDF_WALK_SHARES) + row * ACDF_WORD(tables, ACDF_WALK_STRIDE) + split;
    ACDF_LET(ACDF_U32, word) = ACDF_WORD(tables, at);
    ACDF_LET(ACDF_F32, smaller) = ACDF_FLOAT(word & 0x7FFFFFFFu);
    return ACDF_SELECT((word >> 31u) == side, smaller, 1.0f - smaller);
}

/* What of a mixture falls into a part of a split. */
ACDF_FN4(AcdfWalkMixture, acdf_mixture_part, ACDF_TABLES, tables, AcdfWalkMixture, given, ACDF_U32, split, ACDF_U32,
         side) {
    ACDF_VAR(AcdfWalkMixture, mix) = given;
    mix.weight0 = mix.weight0 * acdf_walk_share(tables, mix.row0, split, side);
    if (mix.weight1 > 0.0f) {
        mix.weight1 = mix.weight1 * acdf_walk_share(tables, mix.row1, split, side);
    }
    if (mix.weight2 > 0.0f) {
        mix.weight2 = mix.weight2 * acdf_walk_share(tables, mix.row2, split, side);
    }
    if (mix.weight3 > 0.0f) {
        mix.weight3 = mix.weight3 * acdf_walk_share(tables, mix.row3, split, side);
    }
    return mix;
}

/* ---- traversals ------------------------------------------------------------------------------------- */

/* How many words a leaf has; `acdf/shader/walk.h` and `acdf/shader/brdf.h` list them. */
#define ACDF_LEAF_WORDS 10u

/* What is sampled. */
ACDF_STRUCT_BEGIN(AcdfWalkSample)
ACDF_FIELD(ACDF_F32, x) /* a unit direction */
ACDF_FIELD(ACDF_F32, y)
ACDF_FIELD(ACDF_F32, z)
ACDF_FIELD(ACDF_F32, pdf) /* sr^-1; 0: nothing was sampled */
ACDF_STRUCT_END(AcdfWalkSample)

/* A direction with its pdf. */
ACDF_FN2(AcdfWalkSample, acdf_walk_sampled, AcdfVector, d, ACDF_F32, pdf) {
    ACDF_VAR(AcdfWalkSample, sampled);
    sampled.x = d.x;
    sampled.y = d.y;
    sampled.z = d.z;
    sampled.pdf = pdf;
    return sampled;
}

/* Random numbers: what is left of them, of how many steps. */
ACDF_STRUCT_BEGIN(AcdfWalkNumbers)
ACDF_FIELD(ACDF_U32, at0)
ACDF_FIELD(ACDF_U32, at1)
ACDF_FIELD(ACDF_U32, width0)
ACDF_FIELD(ACDF_U32, width1)
ACDF_STRUCT_END(AcdfWalkNumbers)

/* Those of two random words, of which 31 bits are used. */
ACDF_FN2(AcdfWalkNumbers, acdf_walk_numbers, ACDF_U32, n0, ACDF_U32, n1) {
    ACDF_VAR(AcdfWalkNumbers, numbers);
    numbers.at0 = n0 >> 1u;
    numbers.at1 = n1 >> 1u;
    numbers.width0 = 0x80000000u;
    numbers.width1 = 0x80000000u;
    return numbers;
}

/* Where a traversal ends. */
ACDF_STRUCT_BEGIN(AcdfWalkEnd)
ACDF_FIELD(ACDF_U32, leaf)  /* its word */
ACDF_FIELD(ACDF_F32, given) /* what the rows give to it */
ACDF_FIELD(AcdfWalkNumbers, numbers)
ACDF_STRUCT_END(AcdfWalkEnd)

/* Where a traversal with a mixture has come to a leaf, its root. */
ACDF_FN3(AcdfWalkEnd, acdf_walk_end, ACDF_TABLES, tables, AcdfWalkMixture, mix, AcdfWalkNumbers, left) {
    ACDF_VAR(AcdfWalkEnd, end);
    end.leaf = ACDF_WORD(tables, ACDF_WALK_LEAVES) + ACDF_LEAF_WORDS * (mix.root & 0x7FFFFFFFu);
    end.given = acdf_mixture_weight(mix);
    end.numbers = left;
    return end;
}

/* Where in [0, width] of whole numbers the lower one of two parts ends. */
ACDF_FN3(ACDF_U32, acdf_walk_border, ACDF_F32, lower, ACDF_F32, upper, ACDF_U32, width) {
    ACDF_LET(ACDF_F32, sum) = ACDF_MAX(lower + upper, 1e-37f);
    ACDF_LET(ACDF_F32, lesser) = ACDF_MIN(lower, upper) / sum * ACDF_TO_F32(width);
    ACDF_LET(ACDF_U32, steps) = ACDF_MIN(ACDF_TO_U32(lesser), width);
    return ACDF_SELECT(lower > upper, width - steps, steps);
}

/* Leads numbers to a leaf. */
ACDF_FN3(AcdfWalkEnd, acdf_walk_sample_leaf, ACDF_TABLES, tables, AcdfWalkMixture, given, AcdfWalkNumbers,
         numbers) {
    ACDF_LET(ACDF_U32, nodes) = ACDF_WORD(tables, ACDF_WALK_NODES);
    ACDF_VAR(AcdfWalkNumbers, left) = numbers;
    ACDF_VAR(AcdfWalkMixture, mix) = given;
    while (mix.root < ACDF_WALK_LEAF) {
        ACDF_LET(ACDF_U32, node) = nodes + 4u * mix.root;
        ACDF_LET(ACDF_U32, axis) = ACDF_WORD(tables, node) >> 31u;
        ACDF_LET(ACDF_U32, chance) = ACDF_WORD(tables, node + 3u);
        ACDF_LET(ACDF_U32, width) = ACDF_SELECT(axis == 0u, left.width0, left.width1);
        ACDF_LET(ACDF_U32, at) = ACDF_SELECT(axis == 0u, left.at0, left.at1);
        ACDF_VAR(ACDF_U32, border) = 0u;
        if ((chance & ACDF_WALK_SPLIT) != 0u) {
            ACDF_LET(ACDF_U32, split) = chance & 0x3FFFFFFFu;
            ACDF_LET(AcdfWalkMixture, below) = acdf_mixture_part(tables, mix, split, 0u);
            ACDF_LET(AcdfWalkMixture, above) = acdf_mixture_part(tables, mix, split, 1u);
            border = acdf_walk_border(acdf_mixture_weight(below), acdf_mixture_weight(above), width);
            if (at < border) {
                mix = below;
            } else {
                mix = above;
            }
        } else { /* the lesser part: negative where it is the upper one */
            ACDF_LET(ACDF_F32, part) = ACDF_FLOAT(chance & 0x7FFFFFFFu);
            ACDF_LET(ACDF_U32, steps) = ACDF_MIN(ACDF_TO_U32(part * ACDF_TO_F32(width)), width);
            border = ACDF_SELECT(chance == ACDF_BITS(part), steps, width - steps);
        }
        ACDF_LET(ACDF_U32, upper) = ACDF_SELECT(at < border, 0u, 1u);
        ACDF_LET(ACDF_U32, kept) = ACDF_SELECT(upper != 0u, width - border, border);
        ACDF_LET(ACDF_U32, rest) = ACDF_SELECT(upper != 0u, at - border, at);
        if (axis == 0u) {
            left.at0 = rest;
            left.width0 = kept;
        } else {
            left.at1 = rest;
            left.width1 = kept;
        }
        mix.root = ACDF_WORD(tables, node + 1u + upper);
    }
    return acdf_walk_end(tables, mix, left);
}

/* Leads a direction's keys to a leaf. */
ACDF_FN4(AcdfWalkEnd, acdf_walk_find, ACDF_TABLES, tables, AcdfWalkMixture, given, ACDF_U32, key0, ACDF_U32, key1) {
    ACDF_LET(ACDF_U32, nodes) = ACDF_WORD(tables, ACDF_WALK_NODES);
    ACDF_VAR(AcdfWalkMixture, mix) = given;
    while (mix.root < ACDF_WALK_LEAF) {
        ACDF_LET(ACDF_U32, node) = nodes + 4u * mix.root;
        ACDF_LET(ACDF_U32, key) = ACDF_WORD(tables, node);
        ACDF_LET(ACDF_U32, chance) = ACDF_WORD(tables, node + 3u);
        ACDF_LET(ACDF_U32, mine) = ACDF_SELECT((key >> 31u) == 0u, key0, key1);
        ACDF_LET(ACDF_U32, side) = ACDF_SELECT(mine < (key & 0x7FFFFFFFu), 0u, 1u);
        if ((chance & ACDF_WALK_SPLIT) != 0u) {
            mix = acdf_mixture_part(tables, mix, chance & 0x3FFFFFFFu, side);
        }
        mix.root = ACDF_WORD(tables, node + 1u + side);
    }
    return acdf_walk_end(tables, mix, acdf_walk_numbers(0u, 0u));
}

/* The middle of what is left of a number, as a part of its width. */
ACDF_FN2(ACDF_F32, acdf_walk_part, ACDF_U32, at, ACDF_U32, width) {
    return (ACDF_TO_F32(at) + 0.5f) / ACDF_TO_F32(width);
}

#ifdef __cplusplus
}
#endif
#endif
