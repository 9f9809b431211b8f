/* Runtime tables of a local environment whose bins share tiles: its tiles (acdf/tile_tables.h) and, of small files,
 * which cell of which tile holds a direction, and what each row gives to each tile. Made once at load
 * (acdf/reader.h); flat words without pointers, which a GPU takes as they lie.
 *
 * As those of an environment (acdf/cells.h) pieces only answer where it is sure that the traversal finds the same
 * cell, and their results are those of the traversal to the bit. */
#ifndef ACDF_LOCAL_TABLES_H
#define ACDF_LOCAL_TABLES_H

#include <acdf/cells.h>
#include <acdf/tile_tables.h>

#ifdef __cplusplus
extern "C" {
#endif

/* A part of a cell in one piece of the sphere. */
typedef struct AcdfTilePiece {
    float origin[2]; /* the greatest local azimuth (radians) and the least 1 - |z| that surely lie in it; on the
                        octahedral square 1 - 2 u and 2 v - 1 */
    float width[2];  /* from there, the first ones falling */
    uint32_t tile;
    uint32_t reserved;
    double probability; /* of the cell in its tile; 0: no sample falls there */
    double area;        /* 2 pi times the cell's columns times its acdf_grid_height */
} AcdfTilePiece;

/* Two bright tiles, as acdf_bright_tile_weight needs them; of an odd number the last one has share 0. */
typedef struct AcdfBrightTilePair {
    double direction[3][2], radius[2], share[2];
    double quarter[2]; /* of the share to the radius */
} AcdfBrightTilePair;

/* A triangle of the octahedron of normals (acdf/normals.h): bright tiles as its normals see them, and its corners
 * in the order of acdf_octahedral_bins. */
typedef struct AcdfFacet {
    double whole[3];  /* sum of share times direction of the bright tiles that are above the horizons of all, by
                         pairs */
    uint32_t others;  /* bit k: of pair k of bright tiles one is neither above the horizons of all nor below */
    double length[3]; /* of corners from the middle, in steps of an edge */
    float share[3];   /* of their bins; 0 also where that is not stored */
    uint32_t row[3];  /* of the bins */
} AcdfFacet;

/* Offsets in words from the start of this struct, which the arrays follow. */
typedef struct AcdfLocalTables {
    uint32_t words; /* of all */
    uint32_t count; /* of pieces */
    AcdfTileTables tiles;
    AcdfSquares directions; /* keys: acdf_keys_of_direction */
    uint32_t pieces;        /* AcdfTilePiece, `count` of them; 0: the file is too large for such */
    uint32_t parts;         /* f64 a tile of each row: what part of the row it has; 0: as pieces */
    uint32_t heights;       /* f64, one more than there are rows: z between them; 0: not on a lat-long grid */
    uint32_t facets;       /* AcdfFacet, n^2 of each octant, of acdf_local_facet; 0: the octahedron is too large, or
                              there is none */
    uint32_t bright_tiles; /* AcdfBrightTilePair, one two bright tiles */
    uint32_t middles;      /* f32, 3 a tile: the direction (unit to 1e-6) of its middle */
    uint32_t hearts;       /* u16 a split of each row, numbered and counted as in `tiles`: the tile that is reached
                              from it by the brighter halves; 0: there is no room */
    uint32_t octahedral;   /* whether cells lie on the octahedral square */
    uint32_t reserved;
} AcdfLocalTables;
ACDF_STATIC_ASSERT(sizeof(AcdfLocalTables) % 64 == 0); /* arrays are aligned */

ACDF_INLINE const uint32_t* acdf_local_words(const AcdfLocalTables* tables) {
    return (const uint32_t*)(const void*)tables;
}
ACDF_INLINE const double* acdf_local_parts(const AcdfLocalTables* tables, uint32_t row, uint32_t tile_count) {
    return (const double*)(const void*)(acdf_local_words(tables) + tables->parts) + (size_t)row * tile_count;
}
ACDF_INLINE const double* acdf_local_heights(const AcdfLocalTables* tables) {
    return (const double*)(const void*)(acdf_local_words(tables) + tables->heights);
}
ACDF_INLINE const AcdfFacet* acdf_local_facets(const AcdfLocalTables* tables) {
    return (const AcdfFacet*)(const void*)(acdf_local_words(tables) + tables->facets);
}
ACDF_INLINE const AcdfBrightTilePair* acdf_local_bright_tiles(const AcdfLocalTables* tables) {
    return (const AcdfBrightTilePair*)(const void*)(acdf_local_words(tables) + tables->bright_tiles);
}
ACDF_INLINE const float* acdf_local_middle(const AcdfLocalTables* tables, uint32_t tile) {
    return (const float*)(const void*)(acdf_local_words(tables) + tables->middles) + 3 * (size_t)tile;
}
/* Of the row whose codes these are, one a split. */
ACDF_INLINE const uint16_t* acdf_local_hearts(const AcdfLocalTables* tables, const uint8_t* codes) {
    const uint8_t* rows = (const uint8_t*)(const void*)(acdf_local_words(tables) + tables->tiles.rows);
    return (const uint16_t*)(const void*)(acdf_local_words(tables) + tables->hearts) + (codes - rows);
}
ACDF_INLINE const AcdfTileRecord* acdf_local_tile(const AcdfLocalTables* tables, uint32_t tile) {
    return acdf_tile_record(acdf_local_words(tables), &tables->tiles, tile);
}

/* The piece that holds a direction; null where the tree must be traversed. */
ACDF_INLINE const AcdfTilePiece* acdf_local_find_piece(const AcdfLocalTables* tables, const float direction[3]) {
    const uint32_t* words = acdf_local_words(tables);
    const uint16_t* found;
    AcdfDirectionKeys place;
    uint32_t mask;
    if (!acdf_keys_of_direction(tables->octahedral, direction, &place)) return 0;
    mask = acdf_squares_find(words, &tables->directions, place.key0, place.key1, &found);
    for (; mask; mask &= mask - 1) {
        const AcdfTilePiece* piece =
            (const AcdfTilePiece*)(const void*)(words + tables->pieces) + found[acdf_lowest_bit(mask)];
        const float d0 = piece->origin[0] - place.slope, d1 = place.cap - piece->origin[1];
        /* 0 <= d < width by their bits */
        if (acdf_float_bits(d0) < acdf_float_bits(piece->width[0]) &&
            acdf_float_bits(d1) < acdf_float_bits(piece->width[1]))
            return piece;
    }
    return 0;
}

#ifdef __cplusplus
}
#endif
#endif
