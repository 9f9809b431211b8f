/* Samples and pdfs by trees, for shaders: of environments on either grid and of local environments, over the
 * words that acdf::ShaderTables::make_walk (acdf/shader/tables.h) makes. 32-bit words and floats alone, an answer
 * for every number and every direction. `acdf export` writes this text in the languages of shaders (lib/shader);
 * here it is C.
 *
 * Trees (acdf/shader/tree.h) end in leaves: parts of cells that lie in one piece of the sphere
 * (acdf/shader/pieces.h), or cells of the octahedral square.
 *
 * Pdfs are the reader's but for the rounding of floats, below 1e-5 of them. A sample is moved 2^-20 radians
 * (or 2^-20 of the square's side) inwards; the pdf of a direction so close to a border may be the neighbour's.
 */
#ifndef ACDF_SHADER_WALK_H
#define ACDF_SHADER_WALK_H

#include <acdf/shader/point.h>

#ifdef __cplusplus
extern "C" {
#endif

/* ---- leaves ----------------------------------------------------------------------------------------- */

/* The first word of a leaf: quarter, south (bit 2). Next is the pdf in its tile or tree, sr^-1; then of each axis
 * low, width, the least and the greatest that is sampled. Axes are local azimuth (radians) and 1 - |z|, in the
 * south from the pole up, or those of the square. */

/* Keys of a direction: upper parts of splits begin at theirs. */
#define ACDF_WALK_SEAM 20971520u /* key0 of acdf_direction_keys at phi = pi, where columns begin */
#define ACDF_WALK_SOUTH 0x7F000000u

/* ---- pdfs ------------------------------------------------------------------------------------------- */

/* The pdf of what follows the light, sr^-1, where a traversal ended. */
ACDF_FN3(ACDF_F32, acdf_walk_light_pdf, ACDF_TABLES, tables, AcdfShaderPoint, here, AcdfWalkEnd, end) {
    ACDF_LET(ACDF_F32, pdf) = end.given / here.sum * acdf_word_as_float(tables, end.leaf + 1u);
    return ACDF_MIN(pdf, 3.402823466e38f);
}

/* Both parts together: that of the light and that of the cosine to the normal. */
ACDF_FN5(ACDF_F32, acdf_walk_combined_pdf, AcdfShaderPoint, here, ACDF_F32, light, ACDF_F32, x, ACDF_F32, y,
         ACDF_F32, z) {
    ACDF_LET(ACDF_F32, cosine) = ACDF_MAX(here.x * x + here.y * y + here.z * z, 0.0f);
    if (here.cosine == 0.0f) {
        return light;
    }
    return (1.0f - here.cosine) * light + here.cosine * cosine * 0.31830989f;
}

/* The keys of a direction on the grid of the tables. */
ACDF_FN2(AcdfDirectionKeys, acdf_walk_keys, ACDF_TABLES, tables, AcdfUnit, d) {
    ACDF_VAR(AcdfDirectionKeys, place);
    if (ACDF_WORD(tables, ACDF_WALK_OCTAHEDRAL) != 0u) {
        return acdf_square_keys(d.x, d.y, d.z, d.sin2, d.length2);
    }
    place = acdf_direction_keys(d.x, d.y, d.z, d.sin2, d.length2);
    ACDF_LET(ACDF_U32, cap) = ACDF_BITS(place.cap);
    place.key0 = (ACDF_WALK_SEAM - place.key0) & ACDF_DIRECTION_MASK;
    place.key1 = ACDF_SELECT((ACDF_BITS(d.z) >> 31u) != 0u, ACDF_WALK_SOUTH - cap, cap);
    return place;
}

/* The pdf, per steradian, with which acdf_walk_sample samples a direction (unit) at a point. 0 where none falls,
 * and for directions whose length differs from 1 by more than 5e-4 or that are not finite. */
ACDF_FN5(ACDF_F32, acdf_walk_pdf, ACDF_TABLES, tables, AcdfShaderPoint, here, ACDF_F32, x, ACDF_F32, y, ACDF_F32,
         z) {
    ACDF_LET(AcdfUnit, d) = acdf_unit_of(x, y, z);
    if (here.mix.root == ACDF_WALK_NONE || d.length2 == 0.0f) {
        return 0.0f;
    }
    ACDF_LET(AcdfDirectionKeys, place) = acdf_walk_keys(tables, d);
    return acdf_walk_combined_pdf(
        here, acdf_walk_light_pdf(tables, here, acdf_walk_find(tables, here.mix, place.key0, place.key1)), x, y, z);
}

/* ---- samples ------------------------------------------------------------------------------------------ */

/* A coordinate of a leaf, by an axis at a word. */
ACDF_FN3(ACDF_F32, acdf_walk_along, ACDF_TABLES, tables, ACDF_U32, axis, ACDF_F32, part) {
    ACDF_LET(ACDF_F32, at) = acdf_word_as_float(tables, axis) + part * acdf_word_as_float(tables, axis + 1u);
    return ACDF_MIN(ACDF_MAX(at, acdf_word_as_float(tables, axis + 2u)), acdf_word_as_float(tables, axis + 3u));
}

/* The direction that what is left of the numbers picks in a leaf. */
ACDF_FN2(AcdfVector, acdf_walk_direction, ACDF_TABLES, tables, AcdfWalkEnd, end) {
    ACDF_LET(ACDF_U32, flags) = ACDF_WORD(tables, end.leaf);
    ACDF_LET(ACDF_U32, south) = (flags >> 2u) & 1u;
    ACDF_LET(ACDF_U32, up) = ACDF_SELECT(south != 0u, end.numbers.width1 - 1u - end.numbers.at1, end.numbers.at1);
    ACDF_LET(ACDF_F32, along) =
        acdf_walk_along(tables, end.leaf + 2u, acdf_walk_part(end.numbers.at0, end.numbers.width0));
    ACDF_LET(ACDF_F32, height) = acdf_walk_along(tables, end.leaf + 6u, acdf_walk_part(up, end.numbers.width1));
    if (ACDF_WORD(tables, ACDF_WALK_OCTAHEDRAL) != 0u) {
        return acdf_square_direction(1.0f - 2.0f * along, 2.0f * height - 1.0f);
    }
    return acdf_piece_direction(along, height, flags & 3u, south);
}

/* The direction h along a unit axis, p and q across it. */
ACDF_FN4(AcdfVector, acdf_walk_about, AcdfVector, axis, ACDF_F32, p, ACDF_F32, q, ACDF_F32, h) {
    ACDF_LET(ACDF_F32, sign) = ACDF_SELECT(axis.z < 0.0f, -1.0f, 1.0f);
    ACDF_LET(ACDF_F32, a) = -1.0f / (sign + axis.z);
    ACDF_LET(ACDF_F32, b) = axis.x * axis.y * a;
    ACDF_VAR(AcdfVector, d);
    d.x = p * (1.0f + sign * axis.x * axis.x * a) + q * b + h * axis.x;
    d.y = p * (sign * b) + q * (sign + axis.y * axis.y * a) + h * axis.y;
    d.z = p * (-sign * axis.x) - q * axis.y + h * axis.z;
    return d;
}

/* A direction around a unit normal with pdf cos / pi: acdf_cosine_direction. */
ACDF_FN3(AcdfVector, acdf_walk_cosine, AcdfShaderPoint, here, ACDF_F32, u0, ACDF_F32, u1) {
    ACDF_LET(ACDF_F32, h) = ACDF_SQRT(ACDF_MAX(1.0f - u1, 1e-10f));
    ACDF_LET(ACDF_F32, r) = ACDF_SQRT(ACDF_MAX(1.0f - h * h, 0.0f));
    ACDF_LET(AcdfVector, turned) = acdf_turn(u0); /* from phi = -pi up, as acdf_cosine_direction turns */
    return acdf_walk_about(acdf_vector(here.x, here.y, here.z), r * turned.x, r * turned.y, h);
}

/* Samples a direction at a point for two random words: n0 / 2^32 (azimuth) and n1 / 2^32 (elevation) are the random
 * numbers of acdf_local_sample_at and acdf_environment_sample. The pdf is 0 where nothing serves the point. */
ACDF_FN4(AcdfWalkSample, acdf_walk_sample, ACDF_TABLES, tables, AcdfShaderPoint, here, ACDF_U32, n0, ACDF_U32, n1) {
    ACDF_VAR(AcdfWalkNumbers, numbers) = acdf_walk_numbers(n0, n1);
    ACDF_VAR(AcdfVector, d) = acdf_vector(0.0f, 0.0f, 0.0f);
    ACDF_VAR(ACDF_F32, light) = -1.0f; /* pdf of what follows the light, where it is known */
    if (here.mix.root == ACDF_WALK_NONE) {
        return acdf_walk_sampled(d, 0.0f);
    }
    ACDF_LET(ACDF_U32, cosine) = acdf_walk_border(here.cosine, 1.0f - here.cosine, numbers.width0);
    if (numbers.at0 < cosine) {
        d = acdf_walk_cosine(here, acdf_walk_part(numbers.at0, cosine),
                             acdf_walk_part(numbers.at1, numbers.width1));
    } else {
        numbers.at0 = numbers.at0 - cosine;
        numbers.width0 = numbers.width0 - cosine;
        ACDF_LET(AcdfWalkEnd, end) = acdf_walk_sample_leaf(tables, here.mix, numbers);
        d = acdf_walk_direction(tables, end);
        light = acdf_walk_light_pdf(tables, here, end);
    }
    if (light < 0.0f) {
        return acdf_walk_sampled(d, acdf_walk_pdf(tables, here, d.x, d.y, d.z));
    }
    return acdf_walk_sampled(d, acdf_walk_combined_pdf(here, light, d.x, d.y, d.z));
}

#ifdef __cplusplus
}
#endif
#endif
