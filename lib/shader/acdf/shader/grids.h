/* Cells of the fast shape for shaders: regular grids in tiles (acdf/shader/tiles.h), which of their cells a
 * direction lies in, and directions there. One text for processors and for shaders of every language
 * (acdf/dialect.h). */
#ifndef ACDF_SHADER_GRIDS_H
#define ACDF_SHADER_GRIDS_H

#include <acdf/shader/tiles.h>

#ifdef __cplusplus
extern "C" {
#endif

/* ---- cells of tiles --------------------------------------------------------------------------------- */

/* A tile: where it lies, and its grid. */
ACDF_STRUCT_BEGIN(AcdfTileBox)
ACDF_FIELD(ACDF_U32, low0)
ACDF_FIELD(ACDF_U32, low1)
ACDF_FIELD(ACDF_U32, width0)
ACDF_FIELD(ACDF_U32, width1)
ACDF_FIELD(ACDF_U32, shift0) /* cells have 2^shift steps; the last ones what is left */
ACDF_FIELD(ACDF_U32, shift1)
ACDF_FIELD(ACDF_U32, ends)  /* the first sum of its lines; those of its cells follow */
ACDF_FIELD(ACDF_U32, light) /* number of its light and 1; 0: none */
ACDF_STRUCT_END(AcdfTileBox)

/* Of its record: lows, 16 bits each; sides less one, 16 bits each; ends; shifts, 8 bits each, and light. */
ACDF_FN2(AcdfTileBox, acdf_tiles_record, ACDF_TABLES, tables, ACDF_U32, tile) {
    ACDF_LET(ACDF_U32, at) = ACDF_WORD(tables, ACDF_TILES_RECORDS) + 4u * tile;
    ACDF_LET(ACDF_U32, lows) = ACDF_WORD(tables, at);
    ACDF_LET(ACDF_U32, sides) = ACDF_WORD(tables, at + 1u);
    ACDF_LET(ACDF_U32, rest) = ACDF_WORD(tables, at + 3u);
    ACDF_VAR(AcdfTileBox, box);
    box.low0 = lows & 0xFFFFu;
    box.low1 = lows >> 16u;
    box.width0 = (sides & 0xFFFFu) + 1u;
    box.width1 = (sides >> 16u) + 1u;
    box.shift0 = rest & 0xFFu;
    box.shift1 = (rest >> 8u) & 0xFFu;
    box.ends = ACDF_WORD(tables, at + 2u);
    box.light = rest >> 16u;
    return box;
}

/* How many cells a side has. */
ACDF_FN2(ACDF_U32, acdf_tiles_cells, ACDF_U32, width, ACDF_U32, shift) {
    return (width + (1u << shift) - 1u) >> shift;
}

/* Where a cell lies. */
ACDF_STRUCT_BEGIN(AcdfTileCell)
ACDF_FIELD(ACDF_U32, low0)
ACDF_FIELD(ACDF_U32, low1)
ACDF_FIELD(ACDF_U32, width0)
ACDF_FIELD(ACDF_U32, width1)
ACDF_STRUCT_END(AcdfTileCell)

/* The first sum of the cells of a band of a tile's grid. */
ACDF_FN2(ACDF_U32, acdf_tiles_band, AcdfTileBox, box, ACDF_U32, band) {
    return box.ends + acdf_tiles_cells(box.width1, box.shift1) + band * acdf_tiles_cells(box.width0, box.shift0);
}

/* Cell (i, band) of a tile. */
ACDF_FN3(AcdfTileCell, acdf_tiles_cell, AcdfTileBox, box, ACDF_U32, i, ACDF_U32, band) {
    ACDF_LET(ACDF_U32, before0) = i << box.shift0;
    ACDF_LET(ACDF_U32, before1) = band << box.shift1;
    ACDF_VAR(AcdfTileCell, cell);
    cell.low0 = box.low0 + before0;
    cell.low1 = box.low1 + before1;
    cell.width0 = ACDF_MIN(box.width0 - before0, 1u << box.shift0);
    cell.width1 = ACDF_MIN(box.width1 - before1, 1u << box.shift1);
    return cell;
}

/* What part of a tile cell (i, band) has. */
ACDF_FN4(ACDF_F32, acdf_tiles_part, ACDF_TABLES, tables, AcdfTileBox, box, ACDF_U32, i, ACDF_U32, band) {
    ACDF_LET(ACDF_U32, grids) = ACDF_WORD(tables, ACDF_TILES_GRIDS);
    return ACDF_TO_F32(acdf_tiles_inside(tables, grids, 0u, box.ends, band) *
                       acdf_tiles_inside(tables, grids, 0u, acdf_tiles_band(box, band), i)) /
           65025.0f;
}

/* ---- the grid of directions ------------------------------------------------------------------------- */

/* Where a direction lies, in whole steps. */
ACDF_STRUCT_BEGIN(AcdfTileSpot)
ACDF_FIELD(ACDF_U32, column)
ACDF_FIELD(ACDF_U32, row)
ACDF_STRUCT_END(AcdfTileSpot)

/* The step that a part, of 2^32, of so many steps (at most 2^16) lies in. */
ACDF_FN2(ACDF_U32, acdf_tiles_step, ACDF_U32, part, ACDF_U32, steps) {
    return ((part >> 16u) * steps + (((part & 0xFFFFu) * steps) >> 16u)) >> 16u;
}

/* What of a turn, of 2^32, lies before a direction: columns begin at phi = pi and go down. */
ACDF_FN2(ACDF_U32, acdf_tiles_turned, ACDF_F32, x, ACDF_F32, y) {
    ACDF_LET(ACDF_U32, steep) = ACDF_SELECT(ACDF_ABS(y) > ACDF_ABS(x), 1u, 0u);
    ACDF_LET(ACDF_F32, minor) = ACDF_SELECT(steep != 0u, -x, y);
    ACDF_LET(ACDF_F32, major) = ACDF_SELECT(steep != 0u, y, x);
    ACDF_LET(ACDF_U32, quarter) = steep | ((ACDF_BITS(major) >> 30u) & 2u);
    ACDF_LET(ACDF_F32, turned) = acdf_atan_float(ACDF_RATIO(minor, major)) * 683565276.0f; /* 2^32 / (2 pi) */
    ACDF_LET(ACDF_U32, middle) = 0x80000000u - (quarter << 30u);
    return ACDF_SELECT(turned < 0.0f, middle + ACDF_TO_U32(ACDF_ABS(turned)),
                       middle - ACDF_TO_U32(ACDF_ABS(turned)));
}

/* Where a direction lies that acdf_unit_of takes for one. */
ACDF_FN2(AcdfTileSpot, acdf_tiles_spot, ACDF_TABLES, tables, AcdfUnit, d) {
    ACDF_LET(ACDF_U32, columns) = ACDF_WORD(tables, ACDF_TILES_COLUMNS);
    ACDF_LET(ACDF_U32, rows) = ACDF_WORD(tables, ACDF_TILES_ROWS);
    ACDF_VAR(AcdfTileSpot, spot);
    if (ACDF_WORD(tables, ACDF_WALK_OCTAHEDRAL) != 0u) {
        ACDF_LET(AcdfDirectionKeys, place) = acdf_square_keys(d.x, d.y, d.z, d.sin2, d.length2);
        spot.column = acdf_tiles_step(place.key0 << 8u, columns);
        spot.row = acdf_tiles_step(place.key1 << 8u, rows);
    } else {
        ACDF_LET(ACDF_F32, row) = ACDF_TO_F32(rows) * acdf_half_turns(ACDF_SQRT(d.sin2), d.z);
        spot.column = acdf_tiles_step(acdf_tiles_turned(d.x, d.y), columns);
        spot.row = ACDF_MIN(ACDF_TO_U32(row), rows - 1u);
    }
    return spot;
}

/* The tile there. */
ACDF_FN2(ACDF_U32, acdf_tiles_at, ACDF_TABLES, tables, AcdfTileSpot, spot) {
    ACDF_LET(ACDF_U32, splits) = ACDF_WORD(tables, ACDF_TILES_SPLITS);
    ACDF_VAR(ACDF_U32, node) = ACDF_WORD(tables, ACDF_TILES_ROOT);
    while (node < ACDF_TILES_FLAG) {
        ACDF_LET(ACDF_U32, place) = ACDF_WORD(tables, splits + 2u * node);
        ACDF_LET(ACDF_U32, parts) = ACDF_WORD(tables, splits + 2u * node + 1u);
        ACDF_LET(ACDF_U32, mine) = ACDF_SELECT((place & 7u) == 0u, spot.column, spot.row);
        node = ACDF_SELECT(mine < (place >> 3u), parts & 0xFFFFu, parts >> 16u);
    }
    return node - ACDF_TILES_FLAG;
}

/* sin(pi i / (2 rows)). */
ACDF_FN2(ACDF_F32, acdf_tiles_sine, ACDF_TABLES, tables, ACDF_U32, i) {
    return acdf_word_as_float(tables, ACDF_WORD(tables, ACDF_TILES_SINES) + i);
}

/* The difference of z over a cell; on the octahedral square its side along axis 1 times 2. */
ACDF_FN2(ACDF_F32, acdf_tiles_height, ACDF_TABLES, tables, AcdfTileCell, cell) {
    if (ACDF_WORD(tables, ACDF_WALK_OCTAHEDRAL) != 0u) {
        return 2.0f * ACDF_TO_F32(cell.width1) / ACDF_TO_F32(ACDF_WORD(tables, ACDF_TILES_ROWS));
    }
    return 2.0f * acdf_tiles_sine(tables, 2u * cell.low1 + cell.width1) * acdf_tiles_sine(tables, cell.width1);
}

/* ---- directions in cells ---------------------------------------------------------------------------- */

/* A part of a width, at least `inside` from both of its ends. */
ACDF_FN3(ACDF_F32, acdf_tiles_kept, ACDF_F32, x, ACDF_F32, width, ACDF_F32, inside) {
    return ACDF_MAX(ACDF_MIN(x, width - inside), inside);
}

/* The direction `across` columns after a cell's first one, and `down` of its difference of z. */
ACDF_FN4(AcdfVector, acdf_tiles_on_sphere, ACDF_TABLES, tables, AcdfTileCell, cell, ACDF_F32, across, ACDF_F32,
         down) {
    ACDF_LET(ACDF_U32, columns) = ACDF_WORD(tables, ACDF_TILES_COLUMNS);
    ACDF_LET(ACDF_F32, steps) = ACDF_TO_F32(columns);
    ACDF_LET(ACDF_F32, column) = ACDF_TO_F32(cell.low0) + across;
    ACDF_LET(ACDF_U32, quarters) = ACDF_TO_U32(4.0f * column / steps + 0.5f); /* of a turn, from phi = pi down */
    ACDF_LET(ACDF_U32, here) = 4u * cell.low0;
    ACDF_LET(ACDF_U32, there) = quarters * columns;
    ACDF_LET(ACDF_F32, apart) =
        ACDF_SELECT(here < there, -ACDF_TO_F32(there - here), ACDF_TO_F32(here - there)); /* exact */
    ACDF_LET(ACDF_F32, azimuth) = -1.5707963f * ((apart + 4.0f * across) / steps);
    ACDF_LET(ACDF_F32, height) = acdf_tiles_height(tables, cell);
    ACDF_LET(ACDF_F32, north) = acdf_tiles_sine(tables, cell.low1); /* of half the angle from the pole */
    ACDF_LET(ACDF_F32, south) =
        acdf_tiles_sine(tables, ACDF_WORD(tables, ACDF_TILES_ROWS) - cell.low1 - cell.width1);
    ACDF_LET(ACDF_F32, deep) = 2.0f * north * north + down * height;
    ACDF_LET(ACDF_U32, below) = ACDF_SELECT(deep > 1.0f, 1u, 0u);
    ACDF_LET(ACDF_F32, begin) = ACDF_SELECT(below != 0u, 2.0f * south * south, 2.0f * north * north);
    ACDF_LET(ACDF_F32, more) = ACDF_SELECT(below != 0u, height - down * height, down * height);
    ACDF_LET(ACDF_F32, cap) = ACDF_MIN(begin + more, 1.0f);
    ACDF_LET(ACDF_F32, inside) = ACDF_TILES_INSIDE * ACDF_SQRT(cap * (2.0f - cap));
    ACDF_LET(ACDF_F32, kept) = ACDF_MIN(begin + acdf_tiles_kept(more, height, inside), 1.0f);
    return acdf_piece_direction(azimuth, ACDF_MAX(kept, 4.5474735e-13f), (6u - quarters) & 3u, below);
}

/* The direction that what is left of the numbers picks in a cell. */
ACDF_FN3(AcdfVector, acdf_tiles_direction, ACDF_TABLES, tables, AcdfTileCell, cell, AcdfWalkNumbers, numbers) {
    ACDF_LET(ACDF_F32, columns) = ACDF_TO_F32(ACDF_WORD(tables, ACDF_TILES_COLUMNS));
    ACDF_LET(ACDF_F32, rows) = ACDF_TO_F32(ACDF_WORD(tables, ACDF_TILES_ROWS));
    ACDF_LET(ACDF_F32, part0) = acdf_walk_part(numbers.at0, numbers.width0);
    ACDF_LET(ACDF_F32, part1) = acdf_walk_part(numbers.at1, numbers.width1);
    ACDF_LET(ACDF_F32, width0) = ACDF_TO_F32(cell.width0);
    ACDF_LET(ACDF_F32, width1) = ACDF_TO_F32(cell.width1);
    if (ACDF_WORD(tables, ACDF_WALK_OCTAHEDRAL) != 0u) {
        ACDF_LET(ACDF_F32, across) = acdf_tiles_kept(part0 * width0, width0, columns * ACDF_TILES_INSIDE);
        ACDF_LET(ACDF_F32, along) = acdf_tiles_kept(part1 * width1, width1, rows * ACDF_TILES_INSIDE);
        return acdf_square_direction(1.0f - 2.0f * ((ACDF_TO_F32(cell.low0) + across) / columns),
                                     2.0f * ((ACDF_TO_F32(cell.low1) + along) / rows) - 1.0f);
    }
    return acdf_tiles_on_sphere(
        tables, cell, acdf_tiles_kept(part0 * width0, width0, columns * ACDF_TILES_INSIDE * 0.15915494f), part1);
}

/* ---- samples and pdfs ---------------------------------------------------------------------------- */

/* 1: bright tiles and rows of grids serve a point. A compiler that knows the tables leaves them out where there are
 * none.
 */
ACDF_FN2(ACDF_U32, acdf_tiles_serve, ACDF_TABLES, tables, AcdfShaderPoint, here) {
    return ACDF_SELECT(here.mix.root == ACDF_WALK_ON_GRIDS, ACDF_WORD(tables, ACDF_WALK_FAST), 0u);
}

/* The probability of a tile at a point. */
ACDF_FN4(ACDF_F32, acdf_tiles_given, ACDF_TABLES, tables, AcdfShaderPoint, here, ACDF_U32, tile, ACDF_U32, light) {
    if (light != 0u) { /* no row gives it any */
        return acdf_point_bright_tile(tables, here, light - 1u) / here.sum;
    }
    return acdf_mixture_weight(here.mix) / here.sum * acdf_tiles_share(tables, here.mix, tile);
}

/* Pdf per steradian of a direction, of what follows the light. */
ACDF_FN3(ACDF_F32, acdf_tiles_pdf, ACDF_TABLES, tables, AcdfShaderPoint, here, AcdfUnit, d) {
    ACDF_LET(AcdfTileSpot, spot) = acdf_tiles_spot(tables, d);
    ACDF_LET(ACDF_U32, tile) = acdf_tiles_at(tables, spot);
    ACDF_LET(AcdfTileBox, box) = acdf_tiles_record(tables, tile);
    ACDF_LET(ACDF_U32, i) = (spot.column - box.low0) >> box.shift0;
    ACDF_LET(ACDF_U32, band) = (spot.row - box.low1) >> box.shift1;
    ACDF_LET(AcdfTileCell, cell) = acdf_tiles_cell(box, i, band);
    ACDF_LET(ACDF_F32, given) =
        acdf_tiles_given(tables, here, tile, box.light) * acdf_tiles_part(tables, box, i, band);
    ACDF_LET(ACDF_F32, columns) = ACDF_TO_F32(ACDF_WORD(tables, ACDF_TILES_COLUMNS));
    ACDF_LET(ACDF_F32, angle) = 6.2831853f * (ACDF_TO_F32(cell.width0) / columns);
    return ACDF_MIN(given / (angle * acdf_tiles_height(tables, cell)), 3.402823466e38f);
}

/* Samples a direction in a tile; ACDF_WALK_ON_GRIDS: in one that the mixture samples. A group and a tile, then a
 * band and a cell, are chosen by one and the same loop: shaders have functions wherever they are called. */
ACDF_FN4(AcdfVector, acdf_tiles_sample, ACDF_TABLES, tables, AcdfWalkMixture, mix, ACDF_U32, light, AcdfWalkNumbers,
         numbers) {
    ACDF_LET(ACDF_U32, grids) = ACDF_WORD(tables, ACDF_TILES_GRIDS);
    ACDF_LET(AcdfTileSums, groups) = acdf_tiles_groups(tables, mix);
    ACDF_VAR(AcdfWalkNumbers, left) = numbers;
    ACDF_VAR(AcdfTileSums, sums) = groups;
    ACDF_VAR(AcdfTileBox, box) = acdf_tiles_record(tables, 0u);
    ACDF_VAR(AcdfTileSample, sampled);
    ACDF_VAR(ACDF_U32, count) = ACDF_WORD(tables, ACDF_TILES_GROUPS);
    ACDF_VAR(ACDF_U32, band) = 0u;
    ACDF_VAR(ACDF_U32, stage) = ACDF_SELECT(light == ACDF_WALK_ON_GRIDS, 0u, 2u);
    sampled.i = ACDF_SELECT(light == ACDF_WALK_ON_GRIDS, 0u, light);
    while (stage < 4u) {
        if (stage == 1u) {
            ACDF_LET(AcdfTileGroup, group) = acdf_tiles_group(tables, mix, groups, sampled.i);
            sums = group.sums;
            count = 16u;
            band = 16u * sampled.i;
        } else if (stage == 2u) {
            box = acdf_tiles_record(tables, band + sampled.i);
            sums = acdf_tiles_list(grids, box.ends);
            count = acdf_tiles_cells(box.width1, box.shift1);
        } else if (stage == 3u) {
            band = sampled.i;
            sums = acdf_tiles_list(grids, acdf_tiles_band(box, band));
            count = acdf_tiles_cells(box.width0, box.shift0);
        }
        if (stage == 0u || stage == 3u) {
            sampled = acdf_tiles_chosen(left.at0, left.width0);
        } else {
            sampled = acdf_tiles_chosen(left.at1, left.width1);
        }
        sampled = acdf_tiles_choose(tables, sums, count, sampled);
        if (stage == 0u || stage == 3u) {
            left.at0 = sampled.at;
            left.width0 = sampled.width;
        } else {
            left.at1 = sampled.at;
            left.width1 = sampled.width;
        }
        stage = stage + 1u;
    }
    return acdf_tiles_direction(tables, acdf_tiles_cell(box, sampled.i, band), left);
}

#ifdef __cplusplus
}
#endif
#endif
