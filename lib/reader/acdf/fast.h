/* The fast shape of a local environment map (SPEC.md §10.6): rows of cumulative sums over tiles, and a
 * regular grid of cells in each tile. What a sample and a pdf read lies where it is known beforehand, and is
 * searched by vectors: no traversal, no branch on the data. Part of acdf/local.h; freestanding, valid C99, C++17
 * and CUDA/HIP/SYCL.
 *
 * All that decides which tile is sampled, and with which probability, are integers: so samples and pdfs agree
 * to the last bit, with vectors or without. */
#ifndef ACDF_FAST_H
#define ACDF_FAST_H

#include <acdf/blend.h>
#include <acdf/squares.h>

#ifdef __cplusplus
extern "C" {
#endif

enum { ACDF_FAST_ROWS = 3 }; /* of a mixture, at most */

#define ACDF_FAST_STEPS 65025.0 /* 255 * 255 */

/* What a file of this shape has instead of ROWS and curves in tiles; `grid` is null where it has another one. */
typedef struct AcdfFast {
    const uint8_t* grid;    /* chunk GRID */
    const uint16_t* groups; /* chunk SUMS: of each row `ends` cumulative values of groups */
    const uint8_t* tiles;   /* behind these: of each row `stride` cumulative values of tiles in their groups */
    uint32_t ends, stride;
    const uint16_t* upper; /* of each row `upper_ends` cumulative values: every sixteenth of the groups'; or null */
    uint32_t upper_ends;
} AcdfFast;

ACDF_FN uint32_t acdf_fast_group_count(uint32_t tile_count) {
    return (tile_count + ACDF_FAST_GROUP - 1) / ACDF_FAST_GROUP;
}
ACDF_FN uint32_t acdf_fast_ends(uint32_t tile_count) { return (acdf_fast_group_count(tile_count) + 15u) & ~15u; }
ACDF_FN uint32_t acdf_fast_stride(uint32_t tile_count) {
    return ACDF_FAST_GROUP * acdf_fast_group_count(tile_count);
}
ACDF_FN uint32_t acdf_fast_upper_ends(uint32_t ends) { return (ends / 16u + 15u) & ~15u; }

/* Rows as a point mixes them. */
typedef struct AcdfFastMixture {
    const uint16_t* group[ACDF_FAST_ROWS]; /* of the rows; those of any one where the weight is 0 */
    const uint8_t* tile[ACDF_FAST_ROWS];
    const uint16_t* upper[ACDF_FAST_ROWS]; /* null: there is no such table */
    int32_t weight[4];                     /* a[k] of SPEC.md: at most 2^14, and 0; written and read at once */
    double whole;                          /* their sum */
} AcdfFastMixture;

/* Row i of a mixture. What a sample looks at first is asked for, while something else is done; where nothing will
 * be sampled, it is left open. */
ACDF_INLINE void acdf_fast_set_row(const AcdfFast* fast, AcdfFastMixture* mix, int i, uint32_t row,
                                   const int draws) {
    int k;
    mix->group[i] = fast->groups + (size_t)row * fast->ends;
    mix->tile[i] = fast->tiles + (size_t)row * fast->stride;
    if (!draws) return;
    mix->upper[i] = fast->upper ? fast->upper + (size_t)row * fast->upper_ends : 0;
    if (fast->upper) ACDF_PREFETCH(mix->upper[i]);
    for (k = 0; k < 128; k += 32) ACDF_PREFETCH(mix->group[i] + k); /* of most files all */
}

/* The power of two that takes a positive number, of at least 1e-300 and at most 1e300, to between 2^13 and 2^14. */
ACDF_INLINE double acdf_fast_scale(double x) {
    uint64_t bits;
    double out;
    memcpy(&bits, &x, sizeof bits);
    bits = (uint64_t)(2 * 1023 + 13 - (bits >> 52)) << 52;
    memcpy(&out, &bits, sizeof out);
    return out;
}

/* A probability as a quotient: that of pdfs takes the place of its division. */
typedef struct AcdfFastShare {
    double of, all;
} AcdfFastShare;

/* A number u in [0, 1] of a whole, below it. */
ACDF_INLINE double acdf_fast_scaled(double u, double whole) {
    const double x = u * whole, most = whole * (1.0 - 0x1p-53);
    return x < most ? x : most;
}

/* ---- within tiles ----------------------------------------------------------------------------------- */

/* The end before number i of a list, and its own. */
ACDF_INLINE uint32_t acdf_fast_before(const uint8_t* ends, uint32_t i, uint32_t* end) {
    const uint32_t inner = (uint32_t)(i > 0);
    *end = ends[i];
    return ends[i - inner] & (0u - inner);
}

#ifdef ACDF_SSE2
/* Bit i: whether byte i of 32 is at least `least`. */
ACDF_INLINE uint32_t acdf_fast_at_least(const uint8_t* bytes, __m128i least) {
    const __m128i low = _mm_loadu_si128((const __m128i*)(const void*)bytes);
    const __m128i high = _mm_loadu_si128((const __m128i*)(const void*)(bytes + 16));
    return (uint32_t)_mm_movemask_epi8(_mm_cmpeq_epi8(_mm_max_epu8(low, least), low)) |
           (uint32_t)_mm_movemask_epi8(_mm_cmpeq_epi8(_mm_max_epu8(high, least), high)) << 16;
}

/* The first of a list of ends that is above z, below 255. 64 bytes from its start may be read. */
ACDF_INLINE uint32_t acdf_fast_end_of(const uint8_t* ends, double z) {
    const __m128i next = _mm_add_epi32(_mm_cvttpd_epi32(_mm_set_sd(z)), _mm_set1_epi32(1));
    const __m128i least = _mm_shuffle_epi32(_mm_shufflelo_epi16(_mm_unpacklo_epi8(next, next), 0), 0);
    const uint32_t mask = acdf_fast_at_least(ends, least);
    if (mask) return acdf_lowest_bit(mask);
    return 32u + acdf_lowest_bit(acdf_fast_at_least(ends + 32, least));
}
#else
ACDF_INLINE uint32_t acdf_fast_end_of(const uint8_t* ends, double z) {
    const uint32_t at = (uint32_t)(int32_t)z;
    uint32_t i = 0;
    while (!(ends[i] > at)) ++i;
    return i;
}
#endif

/* How many cells a side of so many steps has. */
ACDF_FN uint32_t acdf_fast_cells(uint32_t length, uint32_t shift) {
    return (length + (1u << shift) - 1) >> shift; /* lengths are at most 65536 */
}

/* The grid of a tile: where its ends begin, and its sides. */
typedef struct AcdfFastGrid {
    const uint8_t* ends;
    uint32_t shift[2], count[2];
} AcdfFastGrid;

/* The grid at `root` of a tile whose box is `range`. */
ACDF_FN AcdfFastGrid acdf_fast_grid(const AcdfFast* fast, uint32_t root, const AcdfRange* range) {
    AcdfFastGrid out;
    int axis;
    out.ends = fast->grid + root + 2;
    for (axis = 0; axis < 2; ++axis) {
        out.shift[axis] = fast->grid[root + (uint32_t)axis];
        out.count[axis] = acdf_fast_cells(range[axis].high - range[axis].low, out.shift[axis]);
    }
    return out;
}

/* Cell i of a side: narrows its range. */
ACDF_INLINE void acdf_fast_narrow(AcdfRange* range, uint32_t i, uint32_t shift) {
    const uint32_t low = range->low + (i << shift), left = range->high - low, size = 1u << shift;
    range->low = low;
    range->high = low + (left < size ? left : size);
}

/* One of a list of ends by a number; *steps becomes its probability times 255. */
ACDF_INLINE uint32_t acdf_fast_sample_end(const uint8_t* ends, double* u, uint32_t* steps) {
    const double z = acdf_fast_scaled(*u, 255.0);
    const uint32_t i = acdf_fast_end_of(ends, z);
    uint32_t end;
    const uint32_t before = acdf_fast_before(ends, i, &end);
    *steps = end - before;
    *u = (z - (double)(int32_t)before) / (double)(int32_t)*steps;
    return i;
}

/* Samples a cell in a tile whose box is `range`, which becomes its own. Returns its probability there, of
 * ACDF_FAST_STEPS. */
ACDF_INLINE double acdf_fast_sample_cell(const AcdfFastGrid* grid, double* u, AcdfRange* range) {
    uint32_t of_line, in_line;
    const uint32_t line = acdf_fast_sample_end(grid->ends, &u[1], &of_line);
    const uint32_t cell =
        acdf_fast_sample_end(grid->ends + grid->count[1] + line * grid->count[0], &u[0], &in_line);
    acdf_fast_narrow(&range[0], cell, grid->shift[0]);
    acdf_fast_narrow(&range[1], line, grid->shift[1]);
    return (double)(int32_t)(of_line * in_line);
}

/* The share of the cell that holds a square, and its range; 0 where no sample falls. */
ACDF_INLINE double acdf_fast_find_cell(const AcdfFastGrid* grid, const uint32_t* square, AcdfRange* range) {
    const uint32_t cell = (square[0] - range[0].low) >> grid->shift[0];
    const uint32_t line = (square[1] - range[1].low) >> grid->shift[1];
    uint32_t end, of_line, in_line;
    of_line = acdf_fast_before(grid->ends, line, &end);
    of_line = end - of_line;
    in_line = acdf_fast_before(grid->ends + grid->count[1] + line * grid->count[0], cell, &end);
    in_line = end - in_line;
    acdf_fast_narrow(&range[0], cell, grid->shift[0]);
    acdf_fast_narrow(&range[1], line, grid->shift[1]);
    return (double)(int32_t)(of_line * in_line);
}

#ifdef __cplusplus
}
#endif
#endif
