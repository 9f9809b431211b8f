/* Samples and pdfs of BRDF files for shaders, as acdf/brdf.h says (SPEC.md 11), in floats, over the words that
 * acdf::ShaderTables::make_walk (acdf/shader/tables.h) makes. One text for processors and for shaders of every
 * language (acdf/shader/dialect.h), as `acdf/shader/walk.h` is: a shader has both lights and surfaces.
 *
 * Trees (acdf/shader/tree.h) divide the square of half-vectors, and leaves are its cells. A sample has the pdf
 * of its direction's own position in the cell, as the reader's has.
 *
 * Pdfs are the reader's but for the rounding of floats: below 1e-5 of them, and 1e-6 of them over the cosine of the
 * half-vector to wo. Rounding of the two directions changes more. The reader rounds weights of rows to whole
 * numbers, out of 2^21. Samples follow the same pdf, but other random numbers lead to a cell than in the reader. */
#ifndef ACDF_SHADER_BRDF_H
#define ACDF_SHADER_BRDF_H

#include <acdf/shader/maps.h>

#ifdef __cplusplus
extern "C" {
#endif

/* ---- leaves of half-vectors ------------------------------------------------------------------------- */

/* Words of a leaf: 0; pdf in its tile or tree over |wo + wi| / |wo . (wo + wi)|; of each axis low, width, the
 * first key, and how many. Axes are the azimuth (from -pi up, or that of the upper half where the file is mirrored)
 * and 1 - cos(theta), both as parts of their range. Keys are the azimuth in steps of 2^-24, and the bits of
 * 1 - cos(theta), so that the smallest lobe has as many as the widest.
 *
 * Words of a view: sqrt(1 - cos(theta_o)); its square, and what rounds that to a float; 1 over how far the next
 * view is. */

/* ---- the view --------------------------------------------------------------------------------------- */

/* Made once for a direction of view, it serves all samples there. */
ACDF_STRUCT_BEGIN(AcdfShaderView)
ACDF_FIELD(AcdfWalkMixture, mix)
ACDF_FIELD(ACDF_U32, mirrored)
ACDF_FIELD(ACDF_F32, diffuse) /* share of a cosine lobe about the normal; 1: wo is not above the surface */
ACDF_FIELD(ACDF_F32, sum)     /* of weights */
ACDF_FIELD(ACDF_F32, x)       /* wo */
ACDF_FIELD(ACDF_F32, y)
ACDF_FIELD(ACDF_F32, z)
ACDF_FIELD(ACDF_F32, turn_x) /* where azimuths count from */
ACDF_FIELD(ACDF_F32, turn_y)
ACDF_STRUCT_END(AcdfShaderView)

/* sqrt(1 - z) less that of a view, without cancellation. */
ACDF_FN3(ACDF_F32, acdf_beyond_view, ACDF_TABLES, tables, ACDF_U32, node, ACDF_F32, z) {
    ACDF_LET(ACDF_U32, view) = ACDF_WORD(tables, ACDF_WALK_VIEWS) + 4u * node;
    ACDF_LET(ACDF_F32, square) = ACDF_MAX(1.0f - z, 0.0f);
    ACDF_LET(ACDF_F32, rest) = ACDF_SELECT(square > 0.0f, (1.0f - square) - z, 0.0f); /* of its rounding */
    ACDF_LET(ACDF_F32, more) =
        ((square - acdf_word_as_float(tables, view + 1u)) - acdf_word_as_float(tables, view + 2u)) + rest;
    return more / ACDF_MAX(ACDF_SQRT(square) + acdf_word_as_float(tables, view), 1e-18f);
}

/* The last elevation, but not the very last one, at or below that of wo. */
ACDF_FN2(ACDF_U32, acdf_lower_view, ACDF_TABLES, tables, ACDF_F32, z) {
    ACDF_VAR(ACDF_U32, low) = 0u;
    ACDF_VAR(ACDF_U32, high) = ACDF_WORD(tables, ACDF_WALK_VIEW_COUNT) - 1u;
    while (low + 1u < high) {
        ACDF_LET(ACDF_U32, middle) = (low + high) >> 1u;
        if (acdf_beyond_view(tables, middle, z) >= 0.0f) {
            low = middle;
        } else {
            high = middle;
        }
    }
    return low;
}

/* Adds the row of a bin. */
ACDF_FN4(AcdfShaderView, acdf_view_with, ACDF_TABLES, tables, AcdfShaderView, given, ACDF_U32, bin, ACDF_F32,
         weight) {
    ACDF_LET(ACDF_U32, at) = ACDF_WORD(tables, ACDF_WALK_BINS) + 2u * bin;
    ACDF_LET(ACDF_U32, row) = ACDF_WORD(tables, at);
    ACDF_VAR(AcdfShaderView, view) = given;
    view.mix = acdf_mixture_with(view.mix, row, weight * acdf_word_as_float(tables, at + 1u));
    view.sum = acdf_mixture_weight(view.mix);
    return view;
}

/* Adds those of an elevation around an azimuth: the bins of two columns. */
ACDF_FN5(AcdfShaderView, acdf_view_around, ACDF_TABLES, tables, AcdfShaderView, given, ACDF_U32, node, ACDF_F32,
         azimuth, ACDF_F32, weight) {
    ACDF_LET(ACDF_U32, columns) = ACDF_WORD(tables, ACDF_WALK_AZIMUTHS);
    if (columns == 1u) {
        return acdf_view_with(tables, given, node, weight);
    }
    ACDF_LET(ACDF_U32, whole) = ACDF_TO_U32(azimuth);
    ACDF_LET(ACDF_U32, column) = ACDF_SELECT(whole < columns, whole, 0u); /* phi = pi is -pi */
    ACDF_LET(ACDF_U32, next) = ACDF_SELECT(column + 1u < columns, column + 1u, 0u);
    ACDF_LET(ACDF_F32, part) = azimuth - ACDF_TO_F32(whole);
    return acdf_view_with(tables, acdf_view_with(tables, given, node * columns + column, weight * (1.0f - part)),
                          node * columns + next, weight * part);
}

/* What serves wo, a unit direction above the surface: x tangent, z normal. Nothing serves others. */
ACDF_FN4(AcdfShaderView, acdf_brdf_view_of, ACDF_TABLES, tables, ACDF_F32, x, ACDF_F32, y, ACDF_F32, z) {
    ACDF_LET(ACDF_U32, columns) = ACDF_WORD(tables, ACDF_WALK_AZIMUTHS);
    ACDF_LET(AcdfUnit, unit) = acdf_unit_of(x, y, z);
    ACDF_LET(ACDF_F32, most) = ACDF_MAX(ACDF_ABS(x), ACDF_ABS(y));
    ACDF_VAR(AcdfShaderView, view);
    view.mix = acdf_mixture_below(ACDF_WORD(tables, ACDF_WALK_MIXTURE), 0.0f);
    view.mirrored = ACDF_WORD(tables, ACDF_WALK_MIRRORED);
    view.diffuse = acdf_word_as_float(tables, ACDF_WALK_COSINE);
    view.sum = 0.0f;
    view.x = x;
    view.y = y;
    view.z = z;
    view.turn_x = 1.0f;
    view.turn_y = 0.0f;
    if (unit.length2 == 0.0f || !(z > 0.0f) || columns == 0u) { /* 0: the file is no BRDF */
        view.mix.root = ACDF_WALK_NONE;
        view.diffuse = 1.0f;
        return view;
    }
    if (columns == 1u && most > 1e-37f) {
        ACDF_LET(ACDF_F32, length) = ACDF_SQRT(x / most * (x / most) + y / most * (y / most));
        view.turn_x = x / most / length;
        view.turn_y = y / most / length;
    }
    ACDF_LET(ACDF_F32, turn) = acdf_half_turns(ACDF_ABS(unit.y), unit.x);
    ACDF_LET(ACDF_F32, azimuth) = ACDF_TO_F32(columns) * (0.5f + 0.5f * ACDF_SELECT(y < 0.0f, -turn, turn));
    ACDF_LET(ACDF_U32, lower) = acdf_lower_view(tables, z);
    ACDF_VAR(ACDF_U32, upper) = lower;
    ACDF_VAR(ACDF_F32, t) = 0.0f;
    if (ACDF_WORD(tables, ACDF_WALK_VIEW_COUNT) > 1u) {
        upper = lower + 1u;
        t = acdf_beyond_view(tables, lower, z) *
            acdf_word_as_float(tables, ACDF_WORD(tables, ACDF_WALK_VIEWS) + 4u * lower + 3u);
        t = ACDF_MIN(ACDF_MAX(t, 0.0f), 1.0f);
    }
    view = acdf_view_around(tables, view, lower, azimuth, 1.0f - t);
    view = acdf_view_around(tables, view, upper, azimuth, t);
    if (!(view.sum > 0.0f)) {
        view.mix.root = ACDF_WALK_NONE;
    }
    return view;
}

/* ---- half-vectors ----------------------------------------------------------------------------------- */

/* Where a direction lies. */
ACDF_STRUCT_BEGIN(AcdfShaderHalf)
ACDF_FIELD(ACDF_U32, key0)
ACDF_FIELD(ACDF_U32, key1)
ACDF_FIELD(ACDF_F32, spread) /* |wo + wi| / |wo . (wo + wi)|; 0: the direction has no half-vector */
ACDF_STRUCT_END(AcdfShaderHalf)

/* That of wi for a view. */
ACDF_FN4(AcdfShaderHalf, acdf_half_of, AcdfShaderView, view, ACDF_F32, x, ACDF_F32, y, ACDF_F32, z) {
    ACDF_LET(ACDF_F32, hx) = view.x + x;
    ACDF_LET(ACDF_F32, hy) = view.y + y;
    ACDF_LET(ACDF_F32, hz) = view.z + z;
    ACDF_LET(ACDF_F32, sin2) = hx * hx + hy * hy;
    ACDF_LET(ACDF_F32, length) = ACDF_SQRT(sin2 + hz * hz);
    ACDF_LET(ACDF_F32, below) = ACDF_SELECT(hz < 0.0f, -1.0f, 1.0f); /* reflects as its opposite does */
    ACDF_LET(ACDF_F32, along) = below * (view.turn_x * hx + view.turn_y * hy);
    ACDF_LET(ACDF_F32, across) = below * (view.turn_x * hy - view.turn_y * hx);
    ACDF_LET(ACDF_U32, pole) = ACDF_SELECT(along == 0.0f && across == 0.0f, 1u, 0u);
    ACDF_LET(ACDF_F32, turn) = acdf_half_turns(ACDF_ABS(across), ACDF_SELECT(pole != 0u, 1.0f, along));
    ACDF_LET(ACDF_F32, azimuth) =
        ACDF_SELECT(view.mirrored != 0u, turn, 0.5f + 0.5f * ACDF_SELECT(across < 0.0f, -turn, turn));
    ACDF_LET(ACDF_F32, cap) = sin2 / ACDF_MAX(length * (length + ACDF_ABS(hz)), 1e-37f);
    ACDF_LET(AcdfUnit, unit) = acdf_unit_of(x, y, z);
    ACDF_VAR(AcdfShaderHalf, place);
    place.key0 = ACDF_TO_U32(ACDF_MIN(azimuth, 0.99999994f) * ACDF_SQUARE_STEPS);
    place.key1 = ACDF_BITS(ACDF_MIN(cap, 0.99999994f));
    place.spread = length / ACDF_MAX(ACDF_ABS(view.x * hx + view.y * hy + view.z * hz), 1e-37f);
    if (unit.length2 == 0.0f) {
        place.spread = 0.0f;
    }
    return place;
}

/* Reflects wo at the half-vector of an azimuth and a height, parts of their ranges; `side` of a mirrored file: 1,
 * or -1. */
ACDF_FN4(AcdfVector, acdf_reflected, AcdfShaderView, view, ACDF_F32, azimuth, ACDF_F32, cap, ACDF_F32, side) {
    ACDF_LET(AcdfVector, turned) =
        acdf_turn(ACDF_SELECT(view.mirrored != 0u, 0.5f + 0.5f * side * azimuth, azimuth));
    ACDF_LET(ACDF_F32, radius) = ACDF_SQRT(ACDF_MAX(cap * (2.0f - cap), 0.0f));
    ACDF_LET(ACDF_F32, hx) = radius * (view.turn_x * turned.x - view.turn_y * turned.y);
    ACDF_LET(ACDF_F32, hy) = radius * (view.turn_y * turned.x + view.turn_x * turned.y);
    ACDF_LET(ACDF_F32, hz) = 1.0f - cap;
    ACDF_LET(ACDF_F32, twice) = 2.0f * (view.x * hx + view.y * hy + view.z * hz);
    return acdf_vector(twice * hx - view.x, twice * hy - view.y, twice * hz - view.z);
}

/* ---- pdfs of half-vectors --------------------------------------------------------------------------- */

/* The pdf, in sr^-1, of a direction of height z where a traversal ended: of the cell, and of the cosine's share. */
ACDF_FN5(ACDF_F32, acdf_brdf_pdf_at, ACDF_TABLES, tables, AcdfShaderView, view, AcdfWalkEnd, end, ACDF_F32, spread,
         ACDF_F32, z) {
    ACDF_LET(ACDF_F32, lobe) =
        ACDF_MIN(end.given / view.sum * acdf_word_as_float(tables, end.leaf + 1u) * spread, 3.402823466e38f);
    if (view.diffuse == 0.0f) {
        return lobe;
    }
    return (1.0f - view.diffuse) * lobe + view.diffuse * ACDF_MAX(z, 0.0f) * 0.31830989f;
}

/* The pdf, per steradian, with which acdf_brdf_walk_sample samples wi (unit) for a view. 0 where none falls, and
 * for directions whose length differs from 1 by more than 5e-4 or that are not finite. */
ACDF_FN5(ACDF_F32, acdf_brdf_walk_pdf, ACDF_TABLES, tables, AcdfShaderView, view, ACDF_F32, x, ACDF_F32, y,
         ACDF_F32, z) {
    ACDF_LET(AcdfShaderHalf, place) = acdf_half_of(view, x, y, z);
    if (view.diffuse == 1.0f || place.spread == 0.0f) {
        return 0.0f;
    }
    if (view.mix.root == ACDF_WALK_NONE) {
        return view.diffuse * ACDF_MAX(z, 0.0f) * 0.31830989f;
    }
    return acdf_brdf_pdf_at(tables, view, acdf_walk_find(tables, view.mix, place.key0, place.key1), place.spread,
                            z);
}

/* ---- samples of half-vectors -------------------------------------------------------------------------- */

/* Whether a position lies in the cell of a leaf. */
ACDF_FN3(ACDF_U32, acdf_leaf_holds, ACDF_TABLES, tables, ACDF_U32, leaf, AcdfShaderHalf, place) {
    ACDF_LET(ACDF_U32, inside0) =
        ACDF_SELECT(place.key0 - ACDF_WORD(tables, leaf + 4u) < ACDF_WORD(tables, leaf + 5u), 1u, 0u);
    ACDF_LET(ACDF_U32, inside1) =
        ACDF_SELECT(place.key1 - ACDF_WORD(tables, leaf + 8u) < ACDF_WORD(tables, leaf + 9u), 1u, 0u);
    return ACDF_SELECT(place.spread > 0.0f, inside0 & inside1, 0u);
}

/* A direction as it is returned: rounded, whatever a compiler would make of wo + (d - wo). */
ACDF_FN2(AcdfVector, acdf_as_returned, ACDF_TABLES, tables, AcdfVector, d) {
    ACDF_LET(ACDF_U32, zero) = ACDF_WORD(tables, ACDF_WALK_ZERO);
    return acdf_vector(ACDF_FLOAT(ACDF_BITS(d.x) | zero), ACDF_FLOAT(ACDF_BITS(d.y) | zero),
                       ACDF_FLOAT(ACDF_BITS(d.z) | zero));
}

/* Samples a direction in the cell where a traversal ended. Near its border rounding may carry it over: then it
 * moves towards the middle, so that its pdf is that of the cell. */
ACDF_FN4(AcdfWalkSample, acdf_sample_in_cell, ACDF_TABLES, tables, AcdfShaderView, view, AcdfWalkEnd, end, ACDF_F32,
         side) {
    ACDF_VAR(ACDF_F32, part0) = acdf_walk_part(end.numbers.at0, end.numbers.width0);
    ACDF_VAR(ACDF_F32, part1) = acdf_walk_part(end.numbers.at1, end.numbers.width1);
    ACDF_VAR(AcdfVector, d) = acdf_vector(0.0f, 0.0f, 0.0f);
    ACDF_VAR(ACDF_U32, k) = 0u;
    for (k = 0u; k < 32u; k = k + 1u) {
        ACDF_LET(ACDF_F32, azimuth) =
            acdf_word_as_float(tables, end.leaf + 2u) + part0 * acdf_word_as_float(tables, end.leaf + 3u);
        ACDF_LET(ACDF_F32, cap) =
            acdf_word_as_float(tables, end.leaf + 6u) + part1 * acdf_word_as_float(tables, end.leaf + 7u);
        d = acdf_as_returned(tables, acdf_reflected(view, azimuth, cap, side));
        ACDF_LET(AcdfShaderHalf, place) = acdf_half_of(view, d.x, d.y, d.z);
        if (acdf_leaf_holds(tables, end.leaf, place) != 0u) {
            return acdf_walk_sampled(d, acdf_brdf_pdf_at(tables, view, end, place.spread, d.z));
        }
        part0 = 0.5f + 0.75f * (part0 - 0.5f);
        part1 = 0.5f + 0.75f * (part1 - 0.5f);
    }
    /* wo and wi nearly opposite: their half-vector is lost in rounding. */
    return acdf_walk_sampled(d, ACDF_MAX(acdf_brdf_walk_pdf(tables, view, d.x, d.y, d.z), 1.1754944e-38f));
}

/* Samples wi for a view and two random words: n0 / 2^32 (azimuth of the half-vector) and n1 / 2^32 (its height) are
 * the random numbers of acdf_brdf_sample. The direction wi may lie below the surface. pdf 0 where nothing is
 * reflected. */
ACDF_FN4(AcdfWalkSample, acdf_brdf_walk_sample, ACDF_TABLES, tables, AcdfShaderView, view, ACDF_U32, n0, ACDF_U32,
         n1) {
    ACDF_VAR(AcdfWalkNumbers, numbers) = acdf_walk_numbers(n0, n1);
    ACDF_LET(ACDF_U32, cosine) = acdf_walk_border(view.diffuse, 1.0f - view.diffuse, numbers.width1);
    ACDF_LET(ACDF_F32, side) = ACDF_SELECT((n0 >> 31u) != 0u, 1.0f, -1.0f);
    if (view.diffuse < 1.0f && numbers.at1 < cosine) {
        ACDF_LET(AcdfVector, d) =
            acdf_walk_cosine(acdf_point_of_tree(0u), acdf_walk_part(numbers.at0, numbers.width0),
                             acdf_walk_part(numbers.at1, cosine));
        return acdf_walk_sampled(d, acdf_brdf_walk_pdf(tables, view, d.x, d.y, d.z));
    }
    if (view.mix.root == ACDF_WALK_NONE) {
        return acdf_walk_sampled(acdf_vector(0.0f, 0.0f, 0.0f), 0.0f);
    }
    numbers.at1 = numbers.at1 - cosine;
    numbers.width1 = numbers.width1 - cosine;
    if (view.mirrored != 0u) { /* both halves run through the same table */
        numbers.at0 = ACDF_SELECT((n0 >> 31u) != 0u, n0 - 0x80000000u, 0x7FFFFFFFu - n0);
    }
    return acdf_sample_in_cell(tables, view, acdf_walk_sample_leaf(tables, view.mix, numbers), side);
}

#ifdef __cplusplus
}
#endif
#endif
