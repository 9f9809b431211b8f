/* Environments of several maps for shaders: a sky at coordinates, its samples and pdfs, over the words that
 * acdf::ShaderTables::make (acdf/shader/tables.h) makes. One text for processors and for shaders of every language
 * (acdf/shader/dialect.h).
 *
 * Each map divides the top of the tree by shares of its own; below, all maps share the tree of acdf/shader/tree.h.
 * A sky is a mixture of up to eight maps, and the cone of the sun (acdf/indexed/indexed.h, cone.h). Pdfs are the
 * reader's but for the rounding of floats; at the edge of the cone, where its pdf ends, by some 1e-5 of its peak.
 */
#ifndef ACDF_SHADER_MAPS_H
#define ACDF_SHADER_MAPS_H

#include <acdf/shader/walk.h>

#ifdef __cplusplus
extern "C" {
#endif

/* ---- several maps ----------------------------------------------------------------------------------- */

/* Words from ACDF_WALK_MAPS on. There are three axes; one that the file lacks has one map. Offsets are words from
 * the start of the tables. */
#define ACDF_MAPS_COUNTS 0u      /* of maps along each axis */
#define ACDF_MAPS_STEPS 3u       /* from a map to the next along each */
#define ACDF_MAPS_COORDINATES 6u /* f32, ascending: where those of each axis are */
#define ACDF_MAPS_MAPS 9u    /* 6 words each, f32: share of the light, of it that of the sun; an AcdfShaderSun */
#define ACDF_MAPS_SHARES 10u /* f32, one a split and map: the lesser part, below 0 where it is the upper one */
#define ACDF_MAPS_COUNT 11u  /* of all maps */
#define ACDF_MAPS_ROOTS 12u  /* of the cones' profile (acdf/indexed/cone.h) */
#define ACDF_MAPS_TOTAL 13u  /* f32: integral of all maps together */
#define ACDF_MAPS_WORDS 14u

/* A cone. */
ACDF_STRUCT_BEGIN(AcdfShaderSun)
ACDF_FIELD(ACDF_F32, radius) /* 0: not known */
ACDF_FIELD(ACDF_F32, x)      /* unit */
ACDF_FIELD(ACDF_F32, y)
ACDF_FIELD(ACDF_F32, z)
ACDF_STRUCT_END(AcdfShaderSun)

/* What serves some coordinates. */
ACDF_STRUCT_BEGIN(AcdfShaderSky)
ACDF_FIELD(AcdfWalkMixture, maps0) /* rows are maps; its root serves both */
ACDF_FIELD(AcdfWalkMixture, maps1)
ACDF_FIELD(ACDF_F32, total) /* integral over the sphere, linear between maps */
ACDF_FIELD(ACDF_F32, sun)   /* share of samples in the cone */
ACDF_FIELD(ACDF_F32, x)     /* its axis */
ACDF_FIELD(ACDF_F32, y)
ACDF_FIELD(ACDF_F32, z)
ACDF_FIELD(ACDF_F32, reach) /* 1 - cos(radius) */
ACDF_FIELD(ACDF_U32, roots)
ACDF_STRUCT_END(AcdfShaderSky)

/* Where on an axis. */
ACDF_STRUCT_BEGIN(AcdfShaderPlace)
ACDF_FIELD(ACDF_U32, first)   /* the map before */
ACDF_FIELD(ACDF_F32, between) /* in [0, 1], from there to the next */
ACDF_FIELD(ACDF_U32, step)    /* from map to map */
ACDF_STRUCT_END(AcdfShaderPlace)

/* Beyond an axis its first or last map stands, for NaN the first. */
ACDF_FN4(AcdfShaderPlace, acdf_sky_place, ACDF_TABLES, tables, ACDF_U32, maps, ACDF_U32, axis, ACDF_F32, at) {
    ACDF_LET(ACDF_U32, count) = ACDF_WORD(tables, maps + ACDF_MAPS_COUNTS + axis);
    ACDF_LET(ACDF_U32, coordinates) = ACDF_WORD(tables, maps + ACDF_MAPS_COORDINATES + axis);
    ACDF_VAR(ACDF_U32, high) = count - 1u;
    ACDF_VAR(AcdfShaderPlace, place);
    place.first = 0u;
    place.between = 0.0f;
    place.step = ACDF_WORD(tables, maps + ACDF_MAPS_STEPS + axis);
    if (count == 1u || !(at > acdf_word_as_float(tables, coordinates))) {
        return place;
    }
    while (high - place.first > 1u) {
        ACDF_LET(ACDF_U32, middle) = (place.first + high) >> 1u;
        if (at >= acdf_word_as_float(tables, coordinates + middle)) {
            place.first = middle;
        } else {
            high = middle;
        }
    }
    ACDF_LET(ACDF_F32, low) = acdf_word_as_float(tables, coordinates + place.first);
    ACDF_LET(ACDF_F32, wide) = acdf_word_as_float(tables, coordinates + place.first + 1u) - low;
    place.between = ACDF_MIN((at - low) / wide, 1.0f);
    if (!(wide > 0.0f && wide < 3e38f)) {
        place.between = 1.0f; /* alike as floats, or farther apart than these reach */
    }
    return place;
}

/* ---- the sun ---------------------------------------------------------------------------------------- */

/* That of a map. */
ACDF_FN2(AcdfShaderSun, acdf_sun_of, ACDF_TABLES, tables, ACDF_U32, map) {
    ACDF_LET(ACDF_U32, maps) = ACDF_WORD(tables, ACDF_WALK_MAPS);
    ACDF_LET(ACDF_U32, at) = ACDF_WORD(tables, maps + ACDF_MAPS_MAPS) + 6u * map;
    ACDF_VAR(AcdfShaderSun, sun);
    sun.radius = acdf_word_as_float(tables, at + 2u);
    sun.x = acdf_word_as_float(tables, at + 3u);
    sun.y = acdf_word_as_float(tables, at + 4u);
    sun.z = acdf_word_as_float(tables, at + 5u);
    return sun;
}

/* Between two, along the great circle; where one is not known, the other. */
ACDF_FN3(AcdfShaderSun, acdf_sun_between, AcdfShaderSun, a, AcdfShaderSun, b, ACDF_F32, t) {
    ACDF_LET(ACDF_F32, cross_x) = a.y * b.z - a.z * b.y;
    ACDF_LET(ACDF_F32, cross_y) = a.z * b.x - a.x * b.z;
    ACDF_LET(ACDF_F32, cross_z) = a.x * b.y - a.y * b.x;
    ACDF_LET(ACDF_F32, sine) = ACDF_SQRT(cross_x * cross_x + cross_y * cross_y + cross_z * cross_z);
    ACDF_VAR(AcdfShaderSun, sun) = b;
    if (a.radius == 0.0f) {
        return b;
    }
    if (b.radius == 0.0f || (sine < 1e-6f && t < 0.5f)) {
        sun = a;
    }
    if (b.radius == 0.0f) {
        return sun;
    }
    sun.radius = a.radius + (b.radius - a.radius) * t;
    if (sine < 1e-6f) { /* alike, or opposite: nothing is between */
        return sun;
    }
    ACDF_LET(ACDF_F32, angle) = acdf_half_turns(sine, a.x * b.x + a.y * b.y + a.z * b.z);
    ACDF_LET(AcdfVector, of_a) = acdf_turn(0.5f * (1.0f - t) * angle); /* y: minus the sine */
    ACDF_LET(AcdfVector, of_b) = acdf_turn(0.5f * t * angle);
    ACDF_LET(ACDF_F32, x) = of_a.y * a.x + of_b.y * b.x;
    ACDF_LET(ACDF_F32, y) = of_a.y * a.y + of_b.y * b.y;
    ACDF_LET(ACDF_F32, z) = of_a.y * a.z + of_b.y * b.z;
    ACDF_LET(ACDF_F32, length) = ACDF_SQRT(x * x + y * y + z * z);
    sun.x = -x / length;
    sun.y = -y / length;
    sun.z = -z / length;
    return sun;
}

/* Between a map and the next along an axis. */
ACDF_FN3(AcdfShaderSun, acdf_sun_along, ACDF_TABLES, tables, ACDF_U32, map, AcdfShaderPlace, place) {
    return acdf_sun_between(acdf_sun_of(tables, map), acdf_sun_of(tables, map + place.step), place.between);
}

/* The pdf of the cone for a direction. */
ACDF_FN2(ACDF_F32, acdf_sky_cone, AcdfShaderSky, sky, AcdfUnit, d) {
    ACDF_LET(ACDF_F32, length) = ACDF_SQRT(d.length2);
    ACDF_LET(ACDF_F32, x) = d.x / length - sky.x;
    ACDF_LET(ACDF_F32, y) = d.y / length - sky.y;
    ACDF_LET(ACDF_F32, z) = d.z / length - sky.z;
    ACDF_VAR(ACDF_F32, power) = 1.0f;
    ACDF_VAR(ACDF_F32, peak) = 0.15915494f;
    ACDF_VAR(ACDF_U32, i) = 0u;
    if (sky.sun == 0.0f) {
        return 0.0f;
    }
    ACDF_LET(ACDF_F32, inside) = 1.0f - 0.5f * (x * x + y * y + z * z) / sky.reach;
    if (!(inside > 0.0f)) {
        return 0.0f;
    }
    for (i = 0u; i < sky.roots; i = i + 1u) {
        power = power * power * inside;
        peak = 2.0f * peak;
    }
    return peak / sky.reach * power;
}

/* ---- skies ------------------------------------------------------------------------------------------ */

/* A weight by a factor, as the reader has it: a multiple of 2^-21, and 0 only where it was. */
ACDF_FN2(ACDF_F32, acdf_whole_weight, ACDF_F32, weight, ACDF_F32, factor) {
    ACDF_LET(ACDF_U32, whole) = ACDF_TO_U32(weight * factor * 2097152.0f + 0.5f);
    if (weight == 0.0f) {
        return 0.0f;
    }
    return ACDF_TO_F32(ACDF_MAX(whole, 1u)) / 2097152.0f;
}

/* The same of a mixture. */
ACDF_FN2(AcdfWalkMixture, acdf_whole_mixture, AcdfWalkMixture, given, ACDF_F32, factor) {
    ACDF_VAR(AcdfWalkMixture, mix) = given;
    mix.weight0 = acdf_whole_weight(given.weight0, factor);
    mix.weight1 = acdf_whole_weight(given.weight1, factor);
    mix.weight2 = acdf_whole_weight(given.weight2, factor);
    mix.weight3 = acdf_whole_weight(given.weight3, factor);
    return mix;
}

/* The sky at coordinates, in the order of the file's axes; those of axes that it lacks are of no meaning. Of other
 * files one without samples. */
ACDF_FN4(AcdfShaderSky, acdf_sky_at, ACDF_TABLES, tables, ACDF_F32, first, ACDF_F32, second, ACDF_F32, third) {
    ACDF_LET(ACDF_U32, maps) = ACDF_WORD(tables, ACDF_WALK_MAPS);
    ACDF_VAR(AcdfShaderSky, sky);
    ACDF_VAR(ACDF_F32, light) = 0.0f;
    ACDF_VAR(ACDF_F32, in_cone) = 0.0f;
    ACDF_VAR(ACDF_U32, corner) = 0u;
    sky.maps0 = acdf_mixture_below(ACDF_WALK_NONE, 0.0f);
    sky.maps1 = sky.maps0;
    sky.total = 0.0f;
    sky.sun = 0.0f;
    sky.x = 0.0f;
    sky.y = 0.0f;
    sky.z = 0.0f;
    sky.reach = 0.0f;
    sky.roots = 0u;
    if (maps == 0u) {
        return sky;
    }
    ACDF_LET(AcdfShaderPlace, a) = acdf_sky_place(tables, maps, 0u, first);
    ACDF_LET(AcdfShaderPlace, b) = acdf_sky_place(tables, maps, 1u, second);
    ACDF_LET(AcdfShaderPlace, c) = acdf_sky_place(tables, maps, 2u, third);
    ACDF_LET(ACDF_U32, map) = a.first * a.step + b.first * b.step + c.first * c.step;
    for (corner = 0u; corner < 8u; corner = corner + 1u) {
        ACDF_LET(ACDF_U32, i) = corner & 1u;
        ACDF_LET(ACDF_U32, j) = (corner >> 1u) & 1u;
        ACDF_LET(ACDF_U32, k) = corner >> 2u;
        ACDF_LET(ACDF_U32, other) = map + i * a.step + j * b.step + k * c.step;
        ACDF_LET(ACDF_U32, at) = ACDF_WORD(tables, maps + ACDF_MAPS_MAPS) + 6u * other;
        ACDF_LET(ACDF_F32, weight) =
            ACDF_SELECT(i != 0u, a.between, 1.0f - a.between) * ACDF_SELECT(j != 0u, b.between, 1.0f - b.between) *
            ACDF_SELECT(k != 0u, c.between, 1.0f - c.between) * acdf_word_as_float(tables, at);
        ACDF_LET(ACDF_F32, of_sun) = weight * acdf_word_as_float(tables, at + 1u);
        light = light + weight;
        in_cone = in_cone + of_sun;
        if (k == 0u) {
            sky.maps0 = acdf_mixture_with(sky.maps0, other, weight - of_sun);
        } else {
            sky.maps1 = acdf_mixture_with(sky.maps1, other, weight - of_sun);
        }
    }
    ACDF_LET(ACDF_F32, scale) = 1.0f / (acdf_mixture_weight(sky.maps0) + acdf_mixture_weight(sky.maps1));
    sky.maps0 = acdf_whole_mixture(sky.maps0, scale);
    sky.maps1 = acdf_whole_mixture(sky.maps1, scale);
    sky.maps0.root = ACDF_WORD(tables, ACDF_WALK_MIXTURE);
    sky.total = light * acdf_word_as_float(tables, maps + ACDF_MAPS_TOTAL);
    if (!(in_cone > 0.0f)) {
        return sky;
    }
    ACDF_LET(AcdfShaderSun, low) =
        acdf_sun_between(acdf_sun_along(tables, map, c), acdf_sun_along(tables, map + b.step, c), b.between);
    ACDF_LET(AcdfShaderSun, high) = acdf_sun_between(acdf_sun_along(tables, map + a.step, c),
                                                     acdf_sun_along(tables, map + a.step + b.step, c), b.between);
    ACDF_LET(AcdfShaderSun, sun) = acdf_sun_between(low, high, a.between);
    ACDF_LET(ACDF_F32, sine) = acdf_turn(0.07957747f * sun.radius).y; /* minus the sine of half the radius */
    sky.sun = in_cone / light;
    sky.x = sun.x;
    sky.y = sun.y;
    sky.z = sun.z;
    sky.reach = 2.0f * sine * sine;
    sky.roots = ACDF_WORD(tables, maps + ACDF_MAPS_ROOTS);
    return sky;
}

/* What a map gives to the lower part of a split (0) or to the upper one (1). */
ACDF_FN4(ACDF_F32, acdf_map_share, ACDF_TABLES, tables, ACDF_U32, map, ACDF_U32, split, ACDF_U32, side) {
    ACDF_LET(ACDF_U32, maps) = ACDF_WORD(tables, ACDF_WALK_MAPS);
    ACDF_LET(ACDF_U32, count) = ACDF_WORD(tables, maps + ACDF_MAPS_COUNT);
    ACDF_LET(ACDF_U32, lesser) =
        ACDF_WORD(tables, ACDF_WORD(tables, maps + ACDF_MAPS_SHARES) + split * count + map);
    ACDF_LET(ACDF_F32, part) = ACDF_FLOAT(lesser & 0x7FFFFFFFu);
    return ACDF_SELECT((lesser >> 31u) == side, part, 1.0f - part);
}

/* What of a mixture of maps falls into a part of a split. */
ACDF_FN4(AcdfWalkMixture, acdf_maps_part, ACDF_TABLES, tables, AcdfWalkMixture, given, ACDF_U32, split, ACDF_U32,
         side) {
    ACDF_VAR(AcdfWalkMixture, mix) = given;
    if (mix.weight0 > 0.0f) {
        mix.weight0 = mix.weight0 * acdf_map_share(tables, mix.row0, split, side);
    }
    if (mix.weight1 > 0.0f) {
        mix.weight1 = mix.weight1 * acdf_map_share(tables, mix.row1, split, side);
    }
    if (mix.weight2 > 0.0f) {
        mix.weight2 = mix.weight2 * acdf_map_share(tables, mix.row2, split, side);
    }
    if (mix.weight3 > 0.0f) {
        mix.weight3 = mix.weight3 * acdf_map_share(tables, mix.row3, split, side);
    }
    return mix;
}

/* The node at which a sky is, where it is a split of maps; else ACDF_WALK_NONE. */
ACDF_FN2(ACDF_U32, acdf_sky_node, ACDF_TABLES, tables, AcdfShaderSky, sky) {
    ACDF_LET(ACDF_U32, node) = ACDF_WORD(tables, ACDF_WALK_NODES) + 4u * sky.maps0.root;
    if (sky.maps0.root >= ACDF_WALK_LEAF) {
        return ACDF_WALK_NONE;
    }
    return ACDF_SELECT((ACDF_WORD(tables, node + 3u) & ACDF_WALK_SPLIT) != 0u, node, ACDF_WALK_NONE);
}

/* What of a sky falls into a part of the split at a node. */
ACDF_FN4(AcdfShaderSky, acdf_sky_part, ACDF_TABLES, tables, AcdfShaderSky, given, ACDF_U32, node, ACDF_U32, side) {
    ACDF_LET(ACDF_U32, split) = ACDF_WORD(tables, node + 3u) & 0x3FFFFFFFu;
    ACDF_VAR(AcdfShaderSky, sky) = given;
    sky.maps0 = acdf_maps_part(tables, given.maps0, split, side);
    sky.maps1 = acdf_maps_part(tables, given.maps1, split, side);
    sky.maps0.root = ACDF_WORD(tables, node + 1u + side);
    return sky;
}

/* The probability of where a sky is. */
ACDF_FN1(ACDF_F32, acdf_sky_weight, AcdfShaderSky, sky) {
    return acdf_mixture_weight(sky.maps0) + acdf_mixture_weight(sky.maps1);
}

/* Leads numbers to a leaf. */
ACDF_FN3(AcdfWalkEnd, acdf_sky_sample_leaf, ACDF_TABLES, tables, AcdfShaderSky, given, AcdfWalkNumbers, numbers) {
    ACDF_VAR(AcdfShaderSky, sky) = given;
    ACDF_VAR(AcdfWalkNumbers, left) = numbers;
    ACDF_VAR(ACDF_U32, node) = acdf_sky_node(tables, sky);
    while (node != ACDF_WALK_NONE) {
        ACDF_LET(ACDF_U32, axis) = ACDF_WORD(tables, node) >> 31u;
        ACDF_LET(ACDF_U32, width) = ACDF_SELECT(axis == 0u, left.width0, left.width1);
        ACDF_LET(ACDF_U32, at) = ACDF_SELECT(axis == 0u, left.at0, left.at1);
        ACDF_LET(AcdfShaderSky, below) = acdf_sky_part(tables, sky, node, 0u);
        ACDF_LET(AcdfShaderSky, above) = acdf_sky_part(tables, sky, node, 1u);
        ACDF_LET(ACDF_U32, border) = acdf_walk_border(acdf_sky_weight(below), acdf_sky_weight(above), width);
        if (at < border) {
            sky = below;
        } else {
            sky = above;
        }
        ACDF_LET(ACDF_U32, kept) = ACDF_SELECT(at < border, border, width - border);
        ACDF_LET(ACDF_U32, rest) = ACDF_SELECT(at < border, at, at - border);
        if (axis == 0u) {
            left.at0 = rest;
            left.width0 = kept;
        } else {
            left.at1 = rest;
            left.width1 = kept;
        }
        node = acdf_sky_node(tables, sky);
    }
    return acdf_walk_sample_leaf(tables, acdf_mixture_below(sky.maps0.root, acdf_sky_weight(sky)), left);
}

/* Leads a direction's keys to a leaf. */
ACDF_FN4(AcdfWalkEnd, acdf_sky_find, ACDF_TABLES, tables, AcdfShaderSky, given, ACDF_U32, key0, ACDF_U32, key1) {
    ACDF_VAR(AcdfShaderSky, sky) = given;
    ACDF_VAR(ACDF_U32, node) = acdf_sky_node(tables, sky);
    while (node != ACDF_WALK_NONE) {
        ACDF_LET(ACDF_U32, key) = ACDF_WORD(tables, node);
        ACDF_LET(ACDF_U32, mine) = ACDF_SELECT((key >> 31u) == 0u, key0, key1);
        sky = acdf_sky_part(tables, sky, node, ACDF_SELECT(mine < (key & 0x7FFFFFFFu), 0u, 1u));
        node = acdf_sky_node(tables, sky);
    }
    return acdf_walk_find(tables, acdf_mixture_below(sky.maps0.root, acdf_sky_weight(sky)), key0, key1);
}

/* The pdf of both parts for a direction, whose traversal ended at a leaf. */
ACDF_FN4(ACDF_F32, acdf_sky_both, ACDF_TABLES, tables, AcdfShaderSky, sky, AcdfUnit, d, AcdfWalkEnd, end) {
    ACDF_LET(ACDF_F32, tree) = end.given * acdf_word_as_float(tables, end.leaf + 1u);
    return ACDF_MIN((1.0f - sky.sun) * tree + sky.sun * acdf_sky_cone(sky, d), 3.402823466e38f);
}

/* The pdf, per steradian, with which acdf_sky_sample samples a direction (unit). 0 where none falls, and for
 * directions whose length differs from 1 by more than 5e-4 or that are not finite. */
ACDF_FN5(ACDF_F32, acdf_sky_pdf, ACDF_TABLES, tables, AcdfShaderSky, sky, ACDF_F32, x, ACDF_F32, y, ACDF_F32, z) {
    ACDF_LET(AcdfUnit, d) = acdf_unit_of(x, y, z);
    if (sky.maps0.root == ACDF_WALK_NONE || d.length2 == 0.0f) {
        return 0.0f;
    }
    ACDF_LET(AcdfDirectionKeys, place) = acdf_walk_keys(tables, d);
    return acdf_sky_both(tables, sky, d, acdf_sky_find(tables, sky, place.key0, place.key1));
}

/* A direction of the cone for random numbers: around the axis, and from it. */
ACDF_FN3(AcdfVector, acdf_sky_sample_cone, AcdfShaderSky, sky, ACDF_F32, u0, ACDF_F32, u1) {
    ACDF_VAR(ACDF_F32, inside) = 1.0f - u1;
    ACDF_VAR(ACDF_U32, i) = 0u;
    for (i = 0u; i < sky.roots; i = i + 1u) {
        inside = ACDF_SQRT(inside);
    }
    /* Not at the edge, where floats have another pdf. */
    ACDF_LET(ACDF_F32, away) = sky.reach * (1.0f - ACDF_MAX(inside, 1e-3f));
    ACDF_LET(ACDF_F32, r) = ACDF_SQRT(away * (2.0f - away));
    ACDF_LET(AcdfVector, turned) = acdf_turn(u0);
    return acdf_walk_about(acdf_vector(sky.x, sky.y, sky.z), -r * turned.x, -r * turned.y, 1.0f - away);
}

/* Samples a direction for two random words: n0 / 2^32 (azimuth) and n1 / 2^32 (elevation) are the random numbers of
 * acdf_mixed_sample. The pdf is 0 where the file is none of several maps. */
ACDF_FN4(AcdfWalkSample, acdf_sky_sample, ACDF_TABLES, tables, AcdfShaderSky, sky, ACDF_U32, n0, ACDF_U32, n1) {
    ACDF_VAR(AcdfWalkNumbers, numbers) = acdf_walk_numbers(n0, n1);
    if (sky.maps0.root == ACDF_WALK_NONE) {
        return acdf_walk_sampled(acdf_vector(0.0f, 0.0f, 0.0f), 0.0f);
    }
    ACDF_LET(ACDF_U32, in_cone) = acdf_walk_border(sky.sun, 1.0f - sky.sun, numbers.width1);
    if (numbers.at1 < in_cone) {
        ACDF_LET(AcdfVector, d) = acdf_sky_sample_cone(sky, acdf_walk_part(numbers.at0, numbers.width0),
                                                       acdf_walk_part(numbers.at1, in_cone));
        return acdf_walk_sampled(d, acdf_sky_pdf(tables, sky, d.x, d.y, d.z));
    }
    numbers.at1 = numbers.at1 - in_cone;
    numbers.width1 = numbers.width1 - in_cone;
    ACDF_LET(AcdfWalkEnd, end) = acdf_sky_sample_leaf(tables, sky, numbers);
    ACDF_LET(AcdfVector, d) = acdf_walk_direction(tables, end);
    return acdf_walk_sampled(d, acdf_sky_both(tables, sky, acdf_unit_of(d.x, d.y, d.z), end));
}

#ifdef __cplusplus
}
#endif
#endif
