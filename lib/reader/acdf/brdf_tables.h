/* Runtime tables of a BRDF file whose views share cells: which view is next, which cell holds a half-vector, what
 * each view gives to each cell, and which cell random numbers are likely to lead to. Made once at load
 * (acdf/reader.h); flat words without pointers, which a GPU takes as they lie.
 *
 * Pdfs, and cells of samples, are those of the traversal (acdf/blend.h) to the bit. */
#ifndef ACDF_BRDF_TABLES_H
#define ACDF_BRDF_TABLES_H

#include <acdf/blend.h>
#include <acdf/squares.h>

#ifdef __cplusplus
extern "C" {
#endif

#define ACDF_VIEW_STEPS 1024        /* of 1 - cos(theta_o), in [0, 1] */
#define ACDF_BORDER_STEP_BITS 4     /* steps of a binade of positions, 2^4 */
#define ACDF_BORDER_STEPS (29 << 4) /* positions lie below 2^28 */
#define ACDF_BORDERS_AT_ONCE 8      /* that are compared */

/* Offsets in words from the start of this struct, which the arrays follow. T: stored views. Of two squares between
 * the same neighbours among the borders, on both axes, each cell has both or none. */
typedef struct AcdfBrdfTables {
    uint32_t words;            /* of all */
    uint32_t last;             /* the last view that can be the lower one of two */
    uint32_t stride;           /* T + 1, the last view stands twice */
    uint32_t nodes;            /* f64, 2 a view: its coordinate, and the share of its bin; then infinity and 0 */
    uint32_t guide;            /* u16, ACDF_VIEW_STEPS and 1: the lower view, or one before it */
    uint32_t borders[2];       /* i32 of each axis: where cells end, increasing; then 8 of the largest number */
    uint32_t border_guides[2]; /* u16, ACDF_BORDER_STEPS: how many lie at or below the first position of a step */
    uint32_t columns_between;  /* borders of axis 0, and 1 */
    uint32_t grid;             /* u16: the cell between two borders, azimuths next to each other; 0: too many */
    uint32_t areas;            /* f64 a cell, of grid squares */
    uint32_t parts;            /* f64, `stride` a cell: what part of a view's row it has */
    uint32_t codes;            /* f64, 256: probability of a split's lower part; 256: of its upper part */
    uint32_t paths;            /* AcdfBrdfPath, one a cell */
    uint32_t guesses;          /* u16, 2^(2 guess_bits) a view and the next one: a cell; 0: there are none */
    uint32_t guess_bits;       /* of each number; azimuths next to each other */
    uint32_t reserved[11];
    double inverse[2]; /* of the steps of each axis; exact where there are guesses: they are powers of two */
} AcdfBrdfTables;
ACDF_STATIC_ASSERT(sizeof(AcdfBrdfTables) == 128);

/* How a cell is reached, and where it lies: a cache line. */
#define ACDF_PATH_SPLITS 16
typedef struct AcdfBrdfPath {
    uint64_t ways; /* acdf_brdf_way, four bits a split, from the lowest on; zeros behind the last */
    int32_t low[2], high[2];
    uint16_t beyond[4]; /* by acdf_way_number of the way to a side's split: the cell across its middle */
    uint16_t splits[ACDF_PATH_SPLITS]; /* the first ones on the path */
} AcdfBrdfPath;
ACDF_STATIC_ASSERT(sizeof(AcdfBrdfPath) == 64);

/* A way to go at a split: bit i, whether samples go there of whose random numbers it is true (i & 1) that the one
 * for axis 0 lies below the border, and (i & 2) the one for axis 1. */
ACDF_INLINE uint32_t acdf_brdf_way(uint32_t axis, uint32_t upper) {
    return (axis ? 0xCu : 0xAu) ^ (upper ? 15u : 0u);
}
/* From 0 to 3, odd to upper parts; 3 less is that of the other way. */
ACDF_INLINE uint32_t acdf_way_number(uint64_t way) { return (uint32_t)way & 3u; }

ACDF_INLINE const void* acdf_brdf_words(const AcdfBrdfTables* tables, uint32_t at) {
    return (const uint32_t*)(const void*)tables + at;
}
ACDF_INLINE double acdf_brdf_area(const AcdfBrdfTables* tables, uint32_t number) {
    return ((const double*)acdf_brdf_words(tables, tables->areas))[number];
}
/* What the view `lower` and the next one give to a cell. */
ACDF_INLINE const double* acdf_brdf_parts(const AcdfBrdfTables* tables, uint32_t cell, uint32_t lower) {
    return (const double*)acdf_brdf_words(tables, tables->parts) + (size_t)cell * tables->stride + lower;
}

/* ---- finding ---------------------------------------------------------------------------------------- */

/* Of a view: its coordinate and its share; then those of the next one. */
ACDF_INLINE const double* acdf_brdf_node(const AcdfBrdfTables* tables, uint32_t view) {
    return (const double*)acdf_brdf_words(tables, tables->nodes) + 2 * (size_t)view;
}

/* The last view, but not the very last one, whose coordinate is at most x, in [0, 1]; else 0. x2 is the square of
 * which x is the root: what follows does not wait for that. */
ACDF_INLINE uint32_t acdf_brdf_lower_view(const AcdfBrdfTables* tables, double x, double x2) {
    const double* nodes = acdf_brdf_node(tables, 0);
    uint32_t low = ((const uint16_t*)acdf_brdf_words(tables, tables->guide))[(int32_t)(x2 * ACDF_VIEW_STEPS)];
    while (low < tables->last && nodes[2 * low + 2] <= x) ++low;
    return low;
}

/* How many borders of an axis lie at or below a position, which is at least 0 and below the axis's steps. */
ACDF_INLINE uint32_t acdf_brdf_borders_below(const AcdfBrdfTables* tables, int axis, double position) {
    const int32_t* borders = (const int32_t*)acdf_brdf_words(tables, tables->borders[axis]);
    const uint16_t* guide = (const uint16_t*)acdf_brdf_words(tables, tables->border_guides[axis]);
    const int32_t square = (int32_t)position;
    uint64_t bits;
    uint32_t below;
    position = position > 1.0 ? position : 1.0; /* step 0 has all below 1 too */
    memcpy(&bits, &position, sizeof bits);      /* exponent, then the first bits behind the point */
    below = guide[(uint32_t)(bits >> (52 - ACDF_BORDER_STEP_BITS)) - (0x3FFu << ACDF_BORDER_STEP_BITS)];
    for (;;) {
        uint32_t more = 0;
#ifdef ACDF_SSE2
        const __m128i* some = (const __m128i*)(const void*)(borders + below);
        const __m128i at = _mm_set1_epi32(square);
        const __m128i above = _mm_packs_epi32(_mm_cmpgt_epi32(_mm_loadu_si128(some), at),
                                              _mm_cmpgt_epi32(_mm_loadu_si128(some + 1), at));
        const uint32_t mask = (uint32_t)_mm_movemask_epi8(above) | 1u << 2 * ACDF_BORDERS_AT_ONCE;
        more = acdf_lowest_bit(mask) >> 1;
#else
        for (more = 0; more < ACDF_BORDERS_AT_ONCE; ++more)
            if (borders[below + more] > square) break;
#endif
        below += more;
        if (more < ACDF_BORDERS_AT_ONCE) return below;
    }
}

/* The cell that holds a position; only where tables have a grid. */
ACDF_INLINE uint32_t acdf_brdf_find_cell(const AcdfBrdfTables* tables, const double position[2]) {
    const uint32_t column = acdf_brdf_borders_below(tables, 0, position[0]);
    const uint32_t row = acdf_brdf_borders_below(tables, 1, position[1]);
    return ((const uint16_t*)acdf_brdf_words(tables, tables->grid))[row * tables->columns_between + column];
}

#ifdef __cplusplus
}
#endif
#endif
