/* Draws and densities by trees, for shaders: of environments on either grid and of local environments, over the
 * words that acdf::ShaderTables::make_walk (acdf/shader_tables.h) makes. 32-bit words and floats alone, an answer
 * for every number and every direction. `acdf export` writes this text in the languages of shaders (lib/shader);
 * here it is C.
 *
 * A tree of splits ends in leaves: parts of cells that lie in one piece of the sphere (acdf/pieces.h), or cells of
 * the octahedral square. A split is known by its key, which directions have too, so that one tree serves draws and
 * densities, and both multiply the same factors in the same order. Random numbers are whole, and what is left of
 * them is exact: a cell of probability p is drawn with p but for 2^-24 of it a split, which is where floats put
 * borders.
 *
 * Densities are the reader's but for the rounding of floats, below 1e-5 of them. A draw is moved 2^-20 radians (or
 * 2^-20 of the square's side) inwards; the density of a direction so close to a border may be the neighbour's. */
#ifndef ACDF_SHADER_WALK_H
#define ACDF_SHADER_WALK_H

#include <acdf/shader_point.h>

#ifdef __cplusplus
extern "C" {
#endif

/* ---- walks ------------------------------------------------------------------------------------------ */

/* Words of a leaf: quarter, south (bit 2), and the number of the tile's light and 1 (from bit 3); density in its
 * tile or tree, sr^-1; of each axis low, width, the least and the greatest that is drawn. Axes are local azimuth
 * (radians) and 1 - |z|, in the south from the pole up, or those of the square. */
#define ACDF_LEAF_WORDS 10u

/* Keys of a direction: upper parts of splits begin at theirs. */
#define ACDF_WALK_SEAM 20971520u /* key0 of acdf_place_of at phi = pi, where columns begin */
#define ACDF_WALK_SOUTH 0x7F000000u

/* What is drawn. */
ACDF_STRUCT_BEGIN(AcdfWalkSample)
ACDF_FIELD(ACDF_F32, x) /* a unit direction, towards the light; right-handed, z up */
ACDF_FIELD(ACDF_F32, y)
ACDF_FIELD(ACDF_F32, z)
ACDF_FIELD(ACDF_F32, pdf) /* sr^-1; 0: nothing was drawn */
ACDF_STRUCT_END(AcdfWalkSample)

/* Random numbers: what is left of them, of how many steps. */
ACDF_STRUCT_BEGIN(AcdfWalkNumbers)
ACDF_FIELD(ACDF_U32, at0)
ACDF_FIELD(ACDF_U32, at1)
ACDF_FIELD(ACDF_U32, width0)
ACDF_FIELD(ACDF_U32, width1)
ACDF_STRUCT_END(AcdfWalkNumbers)

/* Where a walk ends. */
ACDF_STRUCT_BEGIN(AcdfWalkEnd)
ACDF_FIELD(ACDF_U32, leaf)  /* its word */
ACDF_FIELD(ACDF_F32, given) /* what the rows give to it */
ACDF_FIELD(AcdfWalkNumbers, numbers)
ACDF_STRUCT_END(AcdfWalkEnd)

/* Where in [0, width] of whole numbers the lower one of two parts ends. */
ACDF_FN3(ACDF_U32, acdf_walk_border, ACDF_F32, lower, ACDF_F32, upper, ACDF_U32, width) {
    ACDF_LET(ACDF_F32, sum) = ACDF_MAX(lower + upper, 1e-37f);
    ACDF_LET(ACDF_F32, lesser) = ACDF_MIN(lower, upper) / sum * ACDF_TO_F32(width);
    ACDF_LET(ACDF_U32, steps) = ACDF_MIN(ACDF_TO_U32(lesser), width);
    return ACDF_SELECT(lower > upper, width - steps, steps);
}

/* Word of the pair of parts into which a row's code divides a split. */
ACDF_FN3(ACDF_U32, acdf_walk_code, ACDF_TABLES, tables, ACDF_U32, row, ACDF_U32, split) {
    ACDF_LET(ACDF_U32, byte) = row * ACDF_WORD(tables, ACDF_WALK_STRIDE) + split;
    ACDF_LET(ACDF_U32, four) = ACDF_WORD(tables, ACDF_WORD(tables, ACDF_WALK_CODE_ROWS) + (byte >> 2u));
    return ACDF_WORD(tables, ACDF_WALK_CODES) + 2u * ((four >> ((byte & 3u) << 3u)) & 0xFFu);
}

/* Leads numbers to a leaf. `here` gives the mixture. */
ACDF_FN4(AcdfWalkEnd, acdf_walk_draw, ACDF_TABLES, tables, AcdfShaderPoint, here, ACDF_U32, root, AcdfWalkNumbers,
         numbers) {
    ACDF_LET(ACDF_U32, nodes) = ACDF_WORD(tables, ACDF_WALK_NODES);
    ACDF_VAR(AcdfWalkNumbers, left) = numbers;
    ACDF_VAR(ACDF_U32, link) = root;
    ACDF_VAR(ACDF_F32, a) = here.weight0;
    ACDF_VAR(ACDF_F32, b) = here.weight1;
    ACDF_VAR(ACDF_F32, c) = here.weight2;
    while (link < ACDF_WALK_LEAF) {
        ACDF_LET(ACDF_U32, node) = nodes + 4u * link;
        ACDF_LET(ACDF_U32, axis) = ACDF_WORD(tables, node) >> 31u;
        ACDF_LET(ACDF_U32, chance) = ACDF_WORD(tables, node + 3u);
        ACDF_LET(ACDF_U32, width) = ACDF_SELECT(axis == 0u, left.width0, left.width1);
        ACDF_LET(ACDF_U32, at) = ACDF_SELECT(axis == 0u, left.at0, left.at1);
        ACDF_VAR(ACDF_U32, border) = 0u;
        if ((chance & ACDF_WALK_SPLIT) != 0u) {
            ACDF_LET(ACDF_U32, split) = chance & 0x3FFFFFFFu;
            ACDF_LET(ACDF_U32, code0) = acdf_walk_code(tables, here.row0, split);
            ACDF_LET(ACDF_U32, code1) = acdf_walk_code(tables, here.row1, split);
            ACDF_LET(ACDF_U32, code2) = acdf_walk_code(tables, here.row2, split);
            border = acdf_walk_border(
                a * acdf_word_as_float(tables, code0) + b * acdf_word_as_float(tables, code1) +
                    c * acdf_word_as_float(tables, code2),
                a * acdf_word_as_float(tables, code0 + 1u) + b * acdf_word_as_float(tables, code1 + 1u) +
                    c * acdf_word_as_float(tables, code2 + 1u),
                width);
            ACDF_LET(ACDF_U32, side) = ACDF_SELECT(at < border, 0u, 1u);
            a = a * acdf_word_as_float(tables, code0 + side);
            b = b * acdf_word_as_float(tables, code1 + side);
            c = c * acdf_word_as_float(tables, code2 + side);
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
        link = ACDF_WORD(tables, node + 1u + upper);
    }
    ACDF_VAR(AcdfWalkEnd, end);
    end.leaf = ACDF_WORD(tables, ACDF_WALK_LEAVES) + ACDF_LEAF_WORDS * (link & 0x7FFFFFFFu);
    end.given = a + b + c;
    end.numbers = left;
    return end;
}

/* Leads a direction's keys to a leaf. */
ACDF_FN4(AcdfWalkEnd, acdf_walk_find, ACDF_TABLES, tables, AcdfShaderPoint, here, ACDF_U32, key0, ACDF_U32, key1) {
    ACDF_LET(ACDF_U32, nodes) = ACDF_WORD(tables, ACDF_WALK_NODES);
    ACDF_VAR(ACDF_U32, link) = here.root;
    ACDF_VAR(ACDF_F32, a) = here.weight0;
    ACDF_VAR(ACDF_F32, b) = here.weight1;
    ACDF_VAR(ACDF_F32, c) = here.weight2;
    while (link < ACDF_WALK_LEAF) {
        ACDF_LET(ACDF_U32, node) = nodes + 4u * link;
        ACDF_LET(ACDF_U32, key) = ACDF_WORD(tables, node);
        ACDF_LET(ACDF_U32, chance) = ACDF_WORD(tables, node + 3u);
        ACDF_LET(ACDF_U32, mine) = ACDF_SELECT((key >> 31u) == 0u, key0, key1);
        ACDF_LET(ACDF_U32, side) = ACDF_SELECT(mine < (key & 0x7FFFFFFFu), 0u, 1u);
        if ((chance & ACDF_WALK_SPLIT) != 0u) {
            ACDF_LET(ACDF_U32, split) = chance & 0x3FFFFFFFu;
            a = a * acdf_word_as_float(tables, acdf_walk_code(tables, here.row0, split) + side);
            b = b * acdf_word_as_float(tables, acdf_walk_code(tables, here.row1, split) + side);
            c = c * acdf_word_as_float(tables, acdf_walk_code(tables, here.row2, split) + side);
        }
        link = ACDF_WORD(tables, node + 1u + side);
    }
    ACDF_VAR(AcdfWalkEnd, end);
    end.leaf = ACDF_WORD(tables, ACDF_WALK_LEAVES) + ACDF_LEAF_WORDS * (link & 0x7FFFFFFFu);
    end.given = a + b + c;
    end.numbers.at0 = 0u;
    end.numbers.at1 = 0u;
    end.numbers.width0 = 1u;
    end.numbers.width1 = 1u;
    return end;
}

/* ---- densities -------------------------------------------------------------------------------------- */

/* Density of what follows the light, sr^-1, where a walk ended: in the tile of a light that of the light. */
ACDF_FN3(ACDF_F32, acdf_walk_light_pdf, ACDF_TABLES, tables, AcdfShaderPoint, here, AcdfWalkEnd, end) {
    ACDF_LET(ACDF_U32, light) = ACDF_WORD(tables, end.leaf) >> 3u;
    ACDF_VAR(ACDF_F32, given) = end.given;
    if (given == 0.0f && light != 0u && here.lights != 0u) {
        given = acdf_point_light(tables, here, light - 1u);
    }
    ACDF_LET(ACDF_F32, pdf) = given / here.sum * acdf_word_as_float(tables, end.leaf + 1u);
    return ACDF_MIN(pdf, 3.402823466e38f);
}

/* Both parts together: that of the light and that of the cosine to the normal. */
ACDF_FN5(ACDF_F32, acdf_walk_density, AcdfShaderPoint, here, ACDF_F32, light, ACDF_F32, x, ACDF_F32, y, ACDF_F32,
         z) {
    ACDF_LET(ACDF_F32, cosine) = ACDF_MAX(here.x * x + here.y * y + here.z * z, 0.0f);
    if (here.cosine == 0.0f) {
        return light;
    }
    return (1.0f - here.cosine) * light + here.cosine * cosine * 0.31830989f;
}

/* Density per steradian with which acdf_walk_sample draws a direction (unit) at a point. 0 where none falls, and
 * for directions whose length differs from 1 by more than 5e-4 or that are not finite. */
ACDF_FN5(ACDF_F32, acdf_walk_pdf, ACDF_TABLES, tables, AcdfShaderPoint, here, ACDF_F32, x, ACDF_F32, y, ACDF_F32,
         z) {
    ACDF_LET(ACDF_U32, pole) =
        ACDF_SELECT(ACDF_ABS(x) + ACDF_ABS(y) < 1e-18f, 1u, 0u); /* which azimuth is all one */
    ACDF_LET(ACDF_F32, a) = ACDF_SELECT(pole != 0u, 1e-18f, x);
    ACDF_LET(ACDF_F32, b) = ACDF_SELECT(pole != 0u, 0.0f, y);
    ACDF_LET(ACDF_F32, sin2) = a * a + b * b;
    ACDF_LET(ACDF_F32, length2) = sin2 + z * z;
    ACDF_VAR(AcdfPlace, place);
    if (here.root == ACDF_WALK_NONE ||
        ACDF_BITS(length2) - 0x3F7FBE7Bu > 0x0000624Cu) { /* 0.9995^2 to 1.0005^2, by their bits */
        return 0.0f;
    }
    if (ACDF_WORD(tables, ACDF_WALK_OCTAHEDRAL) != 0u) {
        place = acdf_square_place(a, b, z, sin2, length2);
    } else {
        place = acdf_place_of(a, b, z, sin2, length2);
        ACDF_LET(ACDF_U32, cap) = ACDF_BITS(place.cap);
        place.key0 = (ACDF_WALK_SEAM - place.key0) & ACDF_DIRECTION_MASK;
        place.key1 = ACDF_SELECT((ACDF_BITS(z) >> 31u) != 0u, ACDF_WALK_SOUTH - cap, cap);
    }
    return acdf_walk_density(
        here, acdf_walk_light_pdf(tables, here, acdf_walk_find(tables, here, place.key0, place.key1)), x, y, z);
}

/* ---- draws ------------------------------------------------------------------------------------------ */

/* The middle of what is left of a number, as a part of its width. */
ACDF_FN2(ACDF_F32, acdf_walk_part, ACDF_U32, at, ACDF_U32, width) {
    return (ACDF_TO_F32(at) + 0.5f) / ACDF_TO_F32(width);
}

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
        return acdf_square_direction(along, height);
    }
    return acdf_piece_direction(along, height, flags & 3u, south);
}

/* A direction around a unit normal with density cos / pi: acdf_cosine_direction. */
ACDF_FN3(AcdfVector, acdf_walk_cosine, AcdfShaderPoint, here, ACDF_F32, u0, ACDF_F32, u1) {
    ACDF_LET(ACDF_F32, h) = ACDF_SQRT(ACDF_MAX(1.0f - u1, 1e-10f));
    ACDF_LET(ACDF_F32, r) = ACDF_SQRT(ACDF_MAX(1.0f - h * h, 0.0f));
    ACDF_LET(ACDF_U32, quarter) = ACDF_TO_U32(4.0f * u0 + 0.5f);
    ACDF_LET(ACDF_F32, angle) = (4.0f * u0 - ACDF_TO_F32(quarter)) * 1.5707963f;
    ACDF_LET(ACDF_F32, s) = acdf_sine_float(angle);
    ACDF_LET(ACDF_F32, c) = acdf_cosine_float(angle);
    /* From phi = -pi up, as acdf_cosine_direction turns. */
    ACDF_LET(ACDF_F32, p) =
        r * ACDF_SELECT((quarter & 1u) != 0u, s, -c) * ACDF_SELECT((quarter & 2u) != 0u, -1.0f, 1.0f);
    ACDF_LET(ACDF_F32, q) =
        r * ACDF_SELECT((quarter & 1u) != 0u, -c, -s) * ACDF_SELECT((quarter & 2u) != 0u, -1.0f, 1.0f);
    ACDF_LET(ACDF_F32, sign) = ACDF_SELECT(here.z < 0.0f, -1.0f, 1.0f);
    ACDF_LET(ACDF_F32, a) = -1.0f / (sign + here.z);
    ACDF_LET(ACDF_F32, b) = here.x * here.y * a;
    ACDF_VAR(AcdfVector, d);
    d.x = p * (1.0f + sign * here.x * here.x * a) + q * b + h * here.x;
    d.y = p * (sign * b) + q * (sign + here.y * here.y * a) + h * here.y;
    d.z = p * (-sign * here.x) - q * here.y + h * here.z;
    return d;
}

/* Leads numbers into a light: what is left of them ends in its tile. */
ACDF_FN3(AcdfWalkEnd, acdf_walk_draw_light, ACDF_TABLES, tables, AcdfShaderPoint, here, AcdfWalkNumbers, numbers) {
    ACDF_VAR(AcdfWalkNumbers, left) = numbers;
    ACDF_VAR(ACDF_F32, rest) = here.light_sum;
    ACDF_VAR(ACDF_U32, light) = 0u;
    ACDF_VAR(ACDF_U32, k) = 0u;
    ACDF_VAR(ACDF_U32, found) = 0u;
    for (k = 0u; k < here.lights && found == 0u; k = k + 1u) {
        ACDF_LET(ACDF_F32, weight) = acdf_point_light(tables, here, k);
        if (weight > 0.0f) {
            rest = ACDF_MAX(rest - weight, 0.0f);
            light = k;
            ACDF_LET(ACDF_U32, border) = acdf_walk_border(weight, rest, left.width0);
            if (left.at0 < border) {
                left.width0 = border;
                found = 1u;
            } else {
                left.at0 = left.at0 - border;
                left.width0 = left.width0 - border;
            }
        }
    }
    return acdf_walk_draw(tables, acdf_point_of_tree(0u),
                          ACDF_WORD(tables, ACDF_WORD(tables, ACDF_WALK_LIGHTS) + 8u * light + 5u), left);
}

/* Draws a direction at a point for two random words: n0 / 2^32 (azimuth) and n1 / 2^32 (elevation) are the random
 * numbers of acdf_local_sample_at and acdf_environment_sample. pdf 0 where nothing serves the point. */
ACDF_FN4(AcdfWalkSample, acdf_walk_sample, ACDF_TABLES, tables, AcdfShaderPoint, here, ACDF_U32, n0, ACDF_U32, n1) {
    ACDF_VAR(AcdfWalkNumbers, numbers);
    ACDF_VAR(AcdfWalkSample, drawn);
    ACDF_VAR(AcdfVector, d);
    ACDF_VAR(AcdfWalkEnd, end);
    numbers.at0 = n0 >> 1u;
    numbers.at1 = n1 >> 1u;
    numbers.width0 = 0x80000000u;
    numbers.width1 = 0x80000000u;
    drawn.x = 0.0f;
    drawn.y = 0.0f;
    drawn.z = 0.0f;
    drawn.pdf = 0.0f;
    if (here.root == ACDF_WALK_NONE) {
        return drawn;
    }
    ACDF_LET(ACDF_U32, cosine) = acdf_walk_border(here.cosine, 1.0f - here.cosine, numbers.width0);
    if (numbers.at0 < cosine) {
        d = acdf_walk_cosine(here, acdf_walk_part(numbers.at0, cosine),
                             acdf_walk_part(numbers.at1, numbers.width1));
        drawn.pdf = acdf_walk_pdf(tables, here, d.x, d.y, d.z);
    } else {
        numbers.at0 = numbers.at0 - cosine;
        numbers.width0 = numbers.width0 - cosine;
        ACDF_LET(ACDF_U32, lit) = acdf_walk_border(here.light_sum, here.sum - here.light_sum, numbers.width0);
        if (numbers.at0 < lit) {
            numbers.width0 = lit;
            end = acdf_walk_draw_light(tables, here, numbers);
            end.given = 0.0f; /* by the mixture */
        } else {
            numbers.at0 = numbers.at0 - lit;
            numbers.width0 = numbers.width0 - lit;
            end = acdf_walk_draw(tables, here, here.root, numbers);
        }
        d = acdf_walk_direction(tables, end);
        drawn.pdf = acdf_walk_density(here, acdf_walk_light_pdf(tables, here, end), d.x, d.y, d.z);
    }
    drawn.x = d.x;
    drawn.y = d.y;
    drawn.z = d.z;
    return drawn;
}

#ifdef __cplusplus
}
#endif
#endif
