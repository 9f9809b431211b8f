/* Runtime tables of a local environment whose bins share tiles, for densities: which cell of which tile holds a
 * direction, and what each row gives to each tile. Made once at load (acdf/reader.h); flat words without pointers,
 * which a GPU takes as they lie.
 *
 * As those of an environment (acdf/cells.h) they only answer where it is sure that the walk finds the same cell,
 * and what they tell is the walk's to the bit. */
#ifndef ACDF_LOCAL_TABLES_H
#define ACDF_LOCAL_TABLES_H

#include <acdf/blend.h>

#ifdef __cplusplus
extern "C" {
#endif

/* A part of a cell in one piece of the sphere. */
typedef struct AcdfTilePiece {
    float origin[2]; /* the greatest local azimuth (radians) and the least 1 - |z| that surely lie in it */
    float width[2];  /* from there, azimuths falling */
    uint32_t tile;
    uint32_t reserved;
    double probability; /* of the cell in its tile; 0: no sample falls there */
    double area;        /* 2 pi times the cell's columns times its difference of z */
} AcdfTilePiece;

/* Offsets in words from the start of this struct, which the arrays follow. */
typedef struct AcdfLocalTables {
    uint32_t words;         /* of all */
    uint32_t count;         /* of pieces */
    AcdfSquares directions; /* keys: acdf_direction_place */
    uint32_t pieces;        /* AcdfTilePiece, `count` of them */
    uint32_t parts;         /* f64 a tile of each row: what part of the row it has */
    uint32_t lights;        /* u8 a tile: the number of its light and 1; 0: it has none */
    uint32_t reserved[2];
} AcdfLocalTables;

ACDF_INLINE const uint32_t* acdf_local_words(const AcdfLocalTables* tables) {
    return (const uint32_t*)(const void*)tables;
}
ACDF_INLINE const double* acdf_local_parts(const AcdfLocalTables* tables, uint32_t row, uint32_t tile_count) {
    return (const double*)(const void*)(acdf_local_words(tables) + tables->parts) + (size_t)row * tile_count;
}
ACDF_INLINE uint32_t acdf_local_light(const AcdfLocalTables* tables, uint32_t tile) {
    return ((const uint8_t*)(const void*)(acdf_local_words(tables) + tables->lights))[tile];
}

/* The piece that holds a direction; null where the tree must be walked. */
ACDF_INLINE const AcdfTilePiece* acdf_local_find_piece(const AcdfLocalTables* tables, const float direction[3]) {
    const uint32_t* words = acdf_local_words(tables);
    const uint16_t* found;
    AcdfPlace place;
    uint32_t mask;
    float azimuth;
    if (!acdf_direction_place(direction, &place)) return 0;
    mask = acdf_squares_find(words, &tables->directions, place.key0, place.key1, &found);
    azimuth = acdf_atan_float(place.slope);
    for (; mask; mask &= mask - 1) {
        const AcdfTilePiece* piece =
            (const AcdfTilePiece*)(const void*)(words + tables->pieces) + found[acdf_lowest_bit(mask)];
        const float d0 = piece->origin[0] - azimuth, d1 = place.cap - piece->origin[1];
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
