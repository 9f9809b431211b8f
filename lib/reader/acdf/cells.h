/* Runtime tables of an environment: the cells of its tree with all that a draw and a density need precomputed, and
 * two grids that lead to them, by random numbers and by direction. Made once at load (acdf/reader.h); flat words
 * without pointers, which a GPU takes as they lie.
 *
 * The tree decides. A table only answers where it is sure that the walk finds the same cell: farther from the
 * cell's borders than all roundings together; else it says so, and the caller walks. So every draw and every
 * density is that of the walk; only where in its cell a draw lies differs, by the rounding of floats.
 *
 * On lat-long grids cells are cut where the pieces of the sphere are (acdf/pieces.h). Those of the octahedral
 * square (acdf/shader_square.h) are one piece each, which lies in it as it is. */
#ifndef ACDF_CELLS_H
#define ACDF_CELLS_H

#include <acdf/pieces.h>
#include <acdf/shader_square.h>
#include <acdf/sphere.h>
#include <acdf/squares.h>

#ifdef __cplusplus
extern "C" {
#endif

/* Offsets in words from the start of this struct, which the arrays follow. */
typedef struct AcdfCells {
    uint32_t words;         /* of all */
    uint32_t count;         /* of pieces of cells */
    AcdfSquares numbers;    /* keys: u in steps of 2^-31 */
    AcdfSquares directions; /* keys: acdf_direction_place */
    uint32_t pieces;        /* AcdfPiece, `count` of them */
    uint32_t densities;     /* f32, sr^-1; 0: no sample falls there */
    uint32_t ends;          /* AcdfPieceEnds, `count` of them, of tables for shaders (acdf/shader.h); else 0 */
    uint32_t octahedral;    /* whether they lie on that square: then axes are 1 - 2 u and 2 v - 1 */
    uint32_t reserved[2];
} AcdfCells;

/* The random numbers of an axis that surely lead into a piece, and where they lead. They begin at low, in steps of
 * 2^-31; d steps of 2^-52 above it, 0 <= d < width, the local azimuth (radians), 1 - |z| or the place on an axis of
 * the square is origin + d * slope.
 * In the south `low` is the upper end, at the pole, and -width < d < 0. Directions from origin to there surely lie
 * in the piece; where numbers do not tell (they may be too few, or none) only that is meant. */
typedef struct AcdfPieceAxis {
    uint32_t low;
    float width; /* its lowest bits: of azimuth two, the quarter; of height one, whether it is south; else 0 */
    float origin, slope;
} AcdfPieceAxis;
typedef struct AcdfPiece {
    AcdfPieceAxis azimuth, height;
} AcdfPiece;

/* Of tables that answer always: all of the numbers that lead into a piece, and of the directions that lie in it.
 * Each pair of numbers and each direction are in one. */
typedef struct AcdfPieceEnds {
    uint32_t numbers[2][2]; /* of azimuth and of height: the first, in steps of 2^-31, and how many */
    float slope[2];         /* from, and to less than: acdf_place_of */
    float cap[2];
} AcdfPieceEnds;

/* Piece `number` of those at `pieces`. */
ACDF_INLINE const AcdfPiece* acdf_piece_of(const uint32_t* pieces, uint32_t number, AcdfPiece* loaded) {
#ifdef ACDF_ON_GPU
    const AcdfFourWords* words = (const AcdfFourWords*)(const void*)pieces + 2 * (size_t)number;
    const AcdfFourWords both[2] = {words[0], words[1]};
    memcpy(loaded, both, sizeof *loaded);
    return loaded;
#else
    (void)loaded;
    return (const AcdfPiece*)(const void*)pieces + number;
#endif
}

/* ---- drawing ---------------------------------------------------------------------------------------- */

/* Numbers in [0, 1) in steps of 2^-52, which are the bits of their fractions where 1 is added. Returns 0 for
 * others.
 */
ACDF_INLINE int acdf_number_steps(double u0, double u1, uint64_t n[2]) {
    const double shifted0 = u0 + 1.0, shifted1 = u1 + 1.0;
    memcpy(&n[0], &shifted0, sizeof shifted0);
    memcpy(&n[1], &shifted1, sizeof shifted1);
    n[0] ^= 0x3FF0000000000000u;
    n[1] ^= 0x3FF0000000000000u;
    return (n[0] | n[1]) >> 52 == 0;
}

/* d of a number in steps of 2^-52. */
ACDF_INLINE float acdf_draw_distance(uint64_t number, uint32_t low) {
    return (float)(int64_t)(number - ((uint64_t)low << 21));
}

/* Draws a direction, with acdf_environment_sample's contract. Returns 0, and leaves `out`, where the tree must be
 * walked: for numbers next to the borders of a cell, or not in [0, 1). */
ACDF_INLINE int acdf_cells_sample(const AcdfCells* cells, double u0, double u1, AcdfDirectionSample* out) {
    const uint32_t* tables = (const uint32_t*)(const void*)cells;
    const uint16_t* found;
    uint64_t n[2];
    AcdfPiece loaded;
    AcdfVector drawn;
    float along, height;
    uint32_t mask;
    if (!acdf_number_steps(u0, u1, n)) return 0;
    mask = acdf_squares_find(tables, &cells->numbers, (uint32_t)(n[0] >> 21), (uint32_t)(n[1] >> 21), &found);
    for (; mask; mask &= mask - 1) {
        const uint32_t cell = found[acdf_lowest_bit(mask)];
        const AcdfPiece* piece = acdf_piece_of(tables + cells->pieces, cell, &loaded);
        const float d0 = acdf_draw_distance(n[0], piece->azimuth.low);
        const float d1 = acdf_draw_distance(n[1], piece->height.low);
        const uint32_t width0 = acdf_float_bits(piece->azimuth.width),
                       width1 = acdf_float_bits(piece->height.width);
        /* 0 <= d < width by their bits; in the south for -d */
        if (!(acdf_float_bits(d0) < width0 && (acdf_float_bits(d1) ^ width1 << 31) < width1)) continue;
        along = piece->azimuth.origin + d0 * piece->azimuth.slope;
        height = piece->height.origin + d1 * piece->height.slope;
        drawn = cells->octahedral ? acdf_square_direction(along, height)
                                  : acdf_piece_direction(along, height, width0 & 3u, width1 & 1u);
        out->direction[0] = drawn.x;
        out->direction[1] = drawn.y;
        out->direction[2] = drawn.z;
        out->pdf = ((const float*)(const void*)(tables + cells->densities))[cell];
        return 1;
    }
    return 0;
}

/* ---- finding ---------------------------------------------------------------------------------------- */

/* Whether floats tell a direction, by its x x + y y and the square of its length: 0.9999 to 1.0001 and 2^-40 up, by
 * their bits, which tell what is not finite, too. */
ACDF_INLINE int acdf_is_direction(float sin2, float length2) {
    return acdf_float_bits(length2) - 0x3F7FF972u <= 0x000009D4u && acdf_float_bits(sin2) >= 0x2B800000u;
}

/* Where a direction lies: in place->slope not the tangent of the local azimuth but that itself. Returns 0 where
 * floats do not tell: within 2^-20 of a pole, and for directions whose length differs from 1 by more than 5e-5 or
 * that are not finite. */
ACDF_INLINE int acdf_direction_place(uint32_t octahedral, const float direction[3], AcdfPlace* place) {
    const float x = direction[0], y = direction[1], z = direction[2];
    const float sin2 = x * x + y * y, length2 = sin2 + z * z;
    if (!acdf_is_direction(sin2, length2)) return 0;
    if (octahedral) {
        *place = acdf_square_place(x, y, z, sin2, length2);
    } else {
        *place = acdf_place_of(x, y, z, sin2, length2);
        place->slope = acdf_atan_float(place->slope);
    }
    return 1;
}

/* The density of a direction into *pdf. Returns 0 where the tree must be walked: next to the borders of a cell, and
 * where acdf_direction_place tells nothing. */
ACDF_INLINE int acdf_cells_pdf(const AcdfCells* cells, const float direction[3], float* pdf) {
    const uint32_t* tables = (const uint32_t*)(const void*)cells;
    const uint16_t* found;
    AcdfPiece loaded;
    AcdfPlace place;
    uint32_t mask;
    if (!acdf_direction_place(cells->octahedral, direction, &place)) return 0;
    mask = acdf_squares_find(tables, &cells->directions, place.key0, place.key1, &found);
    for (; mask; mask &= mask - 1) {
        const uint32_t cell = found[acdf_lowest_bit(mask)];
        const AcdfPiece* piece = acdf_piece_of(tables + cells->pieces, cell, &loaded);
        /* How far it is from `origin`, in the direction of growing cap and falling azimuth. */
        const float d0 = piece->azimuth.origin - place.slope, d1 = place.cap - piece->height.origin;
        const float width0 = -(piece->azimuth.width * piece->azimuth.slope);
        const float width1 = fabsf(piece->height.width * piece->height.slope);
        /* 0 <= d < width by their bits */
        if (!(acdf_float_bits(d0) < acdf_float_bits(width0) && acdf_float_bits(d1) < acdf_float_bits(width1)))
            continue;
        *pdf = ((const float*)(const void*)(tables + cells->densities))[cell];
        return 1;
    }
    return 0;
}

#ifdef __cplusplus
}
#endif
#endif
