/* The fast shape of a local environment map (SPEC.md §5.11, §6.13): rows of cumulative sums over tiles, and a
 * regular grid of cells in each tile. What a draw and a density read lies where it is known beforehand, and is
 * searched by vectors: no walk, no branch on the data. Part of acdf/local.h; freestanding, valid C99, C++17 and
 * CUDA/HIP/SYCL.
 *
 * All that decides which tile is drawn, and with which probability, are integers: so draws and densities agree to
 * the last bit, with vectors or without. */
#ifndef ACDF_FAST_H
#define ACDF_FAST_H

#include <acdf/blend.h>
#include <acdf/squares.h>

#ifdef __cplusplus
extern "C" {
#endif

enum { ACDF_FAST_ROWS = 3 }; /* of a mixture, at most */

/* What a file of this shape has instead of ROWS and curves in tiles; `grid` is null where it has another one. */
typedef struct AcdfFast {
    const uint8_t* grid;    /* chunk GRID */
    const uint16_t* groups; /* chunk SUMS: of each row `ends` cumulative values of groups */
    const uint8_t* tiles;   /* behind these: of each row `stride` cumulative values of tiles in their groups */
    uint32_t ends, stride;
} AcdfFast;

ACDF_FN uint32_t acdf_fast_group_count(uint32_t tile_count) {
    return (tile_count + ACDF_FAST_GROUP - 1) / ACDF_FAST_GROUP;
}
ACDF_FN uint32_t acdf_fast_ends(uint32_t tile_count) { return (acdf_fast_group_count(tile_count) + 15u) & ~15u; }
ACDF_FN uint32_t acdf_fast_stride(uint32_t tile_count) {
    return ACDF_FAST_GROUP * acdf_fast_group_count(tile_count);
}

/* Rows as a point mixes them. */
typedef struct AcdfFastMixture {
    const uint16_t* group[ACDF_FAST_ROWS]; /* of the rows; those of any one where the weight is 0 */
    const uint8_t* tile[ACDF_FAST_ROWS];
    int32_t weight[ACDF_FAST_ROWS]; /* a[k] of SPEC.md: at most 2^14 */
    int32_t whole;                  /* their sum */
} AcdfFastMixture;

/* Rows within a group. */
typedef struct AcdfFastGroup {
    int32_t weight[ACDF_FAST_ROWS]; /* b[k]: at most 2^14 */
    int32_t whole;                  /* their sum; 0: no row gives anything to the group */
    int32_t mass;                   /* s: of 32767 times the whole of the mixture, below 2^30 */
} AcdfFastGroup;

/* Row i of a mixture. */
ACDF_INLINE void acdf_fast_set_row(const AcdfFast* fast, AcdfFastMixture* mix, int i, uint32_t row) {
    mix->group[i] = fast->groups + (size_t)row * fast->ends;
    mix->tile[i] = fast->tiles + (size_t)row * fast->stride;
}

/* Asks for what a draw looks at first of a row, while something else is done. */
ACDF_INLINE void acdf_fast_ahead(const AcdfFast* fast, const uint16_t* group) {
    uint32_t i;
    for (i = 0; i < fast->ends && i < 128; i += 32) ACDF_PREFETCH(group + i);
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

/* Sets the weights of a mixture whose rows are set: up to three, positive. */
ACDF_FN void acdf_fast_mix(const double* weight, int rows, AcdfFastMixture* out) {
    double sum = 0.0, scale;
    int i;
    for (i = 0; i < rows; ++i) sum += weight[i];
    scale = acdf_fast_scale(sum);
    out->whole = 0;
    for (i = 0; i < ACDF_FAST_ROWS; ++i) {
        out->weight[i] = i < rows ? (int32_t)(weight[i] * scale) + 1 : 0;
        out->whole += out->weight[i];
    }
}

/* The end before number i of a list, and its own. */
ACDF_INLINE uint32_t acdf_fast_before(const uint8_t* ends, uint32_t i, uint32_t* end) {
    const uint32_t inner = 0u - (uint32_t)(i > 0);
    *end = ends[i];
    return ends[(int32_t)(i + inner)] & inner;
}
ACDF_INLINE uint32_t acdf_fast_group_before(const uint16_t* ends, uint32_t i, uint32_t* end) {
    const uint32_t inner = 0u - (uint32_t)(i > 0);
    *end = ends[i];
    return ends[(int32_t)(i + inner)] & inner;
}

/* How many lower bits of a mass, below 2^30, weights of 14 bits leave out. */
ACDF_INLINE uint32_t acdf_fast_shift(uint32_t mass) {
#if defined(ACDF_ON_GPU) && defined(__NVCC__)
    const uint32_t length = 32u - (uint32_t)__clz((int)(mass | 0x3FFFu));
#elif defined(__GNUC__)
    const uint32_t length = 32u - (uint32_t)__builtin_clz(mass | 0x3FFFu);
#else
    uint32_t length = 14;
    while (mass >> length) ++length;
#endif
    return length - 14;
}

/* What the rows of a mixture give to a group; *below becomes what they give to those before it. */
ACDF_INLINE void acdf_fast_find_group(const AcdfFastMixture* mix, uint32_t group, AcdfFastGroup* out,
                                      int32_t* below) {
    int32_t part[ACDF_FAST_ROWS];
    uint32_t shift;
    int i;
    out->mass = 0;
    *below = 0;
    for (i = 0; i < ACDF_FAST_ROWS; ++i) {
        uint32_t end;
        const uint32_t before = acdf_fast_group_before(mix->group[i], group, &end);
        *below += mix->weight[i] * (int32_t)before;
        part[i] = mix->weight[i] * (int32_t)(end - before);
        out->mass += part[i];
    }
    shift = acdf_fast_shift((uint32_t)out->mass);
    out->whole = 0;
    for (i = 0; i < ACDF_FAST_ROWS; ++i) {
        out->weight[i] = (part[i] + (int32_t)((1u << shift) - 1u)) >> shift;
        out->whole += out->weight[i];
    }
}

/* t of a tile of the group; *below becomes that of those before it. */
ACDF_INLINE int32_t acdf_fast_find_tile(const AcdfFastMixture* mix, const AcdfFastGroup* group, uint32_t tile,
                                        int32_t* below) {
    const uint32_t first = tile & ~(ACDF_FAST_GROUP - 1u), i = tile & (ACDF_FAST_GROUP - 1u);
    int32_t mass = 0;
    int k;
    *below = 0;
    for (k = 0; k < ACDF_FAST_ROWS; ++k) {
        uint32_t end;
        const uint32_t before = acdf_fast_before(mix->tile[k] + first, i, &end);
        *below += group->weight[k] * (int32_t)before;
        mass += group->weight[k] * (int32_t)(end - before);
    }
    return mass;
}

/* The part of the mixture that a tile of the group has, given its t. */
ACDF_INLINE double acdf_fast_part(const AcdfFastMixture* mix, const AcdfFastGroup* group, int32_t mass) {
    return (double)group->mass * (double)mass / (32767.0 * 255.0 * ((double)mix->whole * (double)group->whole));
}

/* The part of the mixture that a tile has. */
ACDF_FN double acdf_fast_share(const AcdfFastMixture* mix, uint32_t tile) {
    AcdfFastGroup group;
    int32_t below, mass;
    acdf_fast_find_group(mix, tile / ACDF_FAST_GROUP, &group, &below);
    mass = acdf_fast_find_tile(mix, &group, tile, &below);
    return group.mass > 0 ? acdf_fast_part(mix, &group, mass) : 0.0;
}

/* A number u in [0, 1] of a whole, below it. */
ACDF_INLINE double acdf_fast_scaled(double u, double whole) {
    const double x = u * whole;
    return x < whole ? x : whole * (1.0 - 0x1p-53);
}

/* ---- searches: how many sums are not above a number, which is less than the last one ---------------- */

#ifdef ACDF_SSE2
/* -1 for each of eight mixed ends (u16, of three rows) that is above x. */
ACDF_INLINE __m128i acdf_fast_above(const __m128i end[3], __m128i weight01, __m128i weight2, __m128i x) {
    const __m128i zero = _mm_setzero_si128();
    const __m128i low = _mm_add_epi32(_mm_madd_epi16(_mm_unpacklo_epi16(end[0], end[1]), weight01),
                                      _mm_madd_epi16(_mm_unpacklo_epi16(end[2], zero), weight2));
    const __m128i high = _mm_add_epi32(_mm_madd_epi16(_mm_unpackhi_epi16(end[0], end[1]), weight01),
                                       _mm_madd_epi16(_mm_unpackhi_epi16(end[2], zero), weight2));
    return _mm_packs_epi32(_mm_cmpgt_epi32(low, x), _mm_cmpgt_epi32(high, x));
}

/* Weights in pairs of 16 bits, as products of vectors take them. */
ACDF_INLINE void acdf_fast_pairs(const int32_t* weight, __m128i* pair01, __m128i* pair2) {
    *pair01 = _mm_set1_epi32(weight[0] | weight[1] << 16);
    *pair2 = _mm_set1_epi32(weight[2]);
}

/* The sum of eight numbers of 16 bits. */
ACDF_INLINE int32_t acdf_fast_total(__m128i numbers) {
    const __m128i pairs = _mm_madd_epi16(numbers, _mm_set1_epi16(1));
    const __m128i two = _mm_add_epi32(pairs, _mm_shuffle_epi32(pairs, 0x4E));
    return _mm_cvtsi128_si32(_mm_add_epi32(two, _mm_shuffle_epi32(two, 0xB1)));
}

ACDF_INLINE uint32_t acdf_fast_group_of(const AcdfFast* fast, const AcdfFastMixture* mix, int32_t x) {
    const __m128i at = _mm_set1_epi32(x);
    __m128i above = _mm_setzero_si128(), pair01, pair2;
    uint32_t i;
    acdf_fast_pairs(mix->weight, &pair01, &pair2);
    for (i = 0; i < fast->ends; i += 8) {
        __m128i end[3];
        int k;
        for (k = 0; k < 3; ++k) end[k] = _mm_loadu_si128((const __m128i*)(const void*)(mix->group[k] + i));
        above = _mm_add_epi16(above, acdf_fast_above(end, pair01, pair2, at));
    }
    return fast->ends + (uint32_t)acdf_fast_total(above);
}

/* The tile in the group whose tiles begin at `first`. */
ACDF_INLINE uint32_t acdf_fast_tile_of(const AcdfFastMixture* mix, const AcdfFastGroup* group, uint32_t first,
                                       int32_t y) {
    const __m128i at = _mm_set1_epi32(y), zero = _mm_setzero_si128();
    __m128i low[3], high[3], pair01, pair2;
    int k;
    acdf_fast_pairs(group->weight, &pair01, &pair2);
    for (k = 0; k < 3; ++k) {
        const __m128i bytes = _mm_loadu_si128((const __m128i*)(const void*)(mix->tile[k] + first));
        low[k] = _mm_unpacklo_epi8(bytes, zero);
        high[k] = _mm_unpackhi_epi8(bytes, zero);
    }
    return ACDF_FAST_GROUP + (uint32_t)acdf_fast_total(_mm_add_epi16(acdf_fast_above(low, pair01, pair2, at),
                                                                     acdf_fast_above(high, pair01, pair2, at)));
}

/* Bit i: whether byte i of 32 is at least `least`. */
ACDF_INLINE uint32_t acdf_fast_at_least(const uint8_t* bytes, __m128i least) {
    const __m128i low = _mm_loadu_si128((const __m128i*)(const void*)bytes);
    const __m128i high = _mm_loadu_si128((const __m128i*)(const void*)(bytes + 16));
    return (uint32_t)_mm_movemask_epi8(_mm_cmpeq_epi8(_mm_max_epu8(low, least), low)) |
           (uint32_t)_mm_movemask_epi8(_mm_cmpeq_epi8(_mm_max_epu8(high, least), high)) << 16;
}

/* The first of a list of ends that is above z, at most 254. 64 bytes from its start may be read. */
ACDF_INLINE uint32_t acdf_fast_end_of(const uint8_t* ends, uint32_t z) {
    const __m128i least = _mm_set1_epi8((int8_t)(uint8_t)(z + 1));
    const uint32_t mask = acdf_fast_at_least(ends, least);
    if (mask) return acdf_lowest_bit(mask);
    return 32u + acdf_lowest_bit(acdf_fast_at_least(ends + 32, least));
}
#else
ACDF_INLINE uint32_t acdf_fast_group_of(const AcdfFast* fast, const AcdfFastMixture* mix, int32_t x) {
    uint32_t low = 0, high = fast->ends - 1;
    while (low < high) {
        const uint32_t middle = (low + high) / 2;
        int32_t sum = 0;
        int k;
        for (k = 0; k < ACDF_FAST_ROWS; ++k) sum += mix->weight[k] * (int32_t)mix->group[k][middle];
        if (sum > x) high = middle;
        else low = middle + 1;
    }
    return low;
}
ACDF_INLINE uint32_t acdf_fast_tile_of(const AcdfFastMixture* mix, const AcdfFastGroup* group, uint32_t first,
                                       int32_t y) {
    uint32_t low = 0, high = ACDF_FAST_GROUP - 1;
    while (low < high) {
        const uint32_t middle = (low + high) / 2;
        int32_t sum = 0;
        int k;
        for (k = 0; k < ACDF_FAST_ROWS; ++k) sum += group->weight[k] * (int32_t)mix->tile[k][first + middle];
        if (sum > y) high = middle;
        else low = middle + 1;
    }
    return low;
}
ACDF_INLINE uint32_t acdf_fast_end_of(const uint8_t* ends, uint32_t z) {
    uint32_t i = 0;
    while (!(ends[i] > z)) ++i;
    return i;
}
#endif

/* Draws a tile; u becomes what is left of the random numbers in [0, 1], *part what the tile has of the mixture. */
ACDF_INLINE uint32_t acdf_fast_draw_tile(const AcdfFast* fast, const AcdfFastMixture* mix, double* u,
                                         double* part) {
    AcdfFastGroup group;
    int32_t below, mass;
    const double x = acdf_fast_scaled(u[0], 32767.0 * (double)mix->whole);
    const uint32_t g = acdf_fast_group_of(fast, mix, (int32_t)x);
    double y;
    uint32_t tile;
    acdf_fast_find_group(mix, g, &group, &below);
    u[0] = (x - (double)below) / (double)group.mass;
    y = acdf_fast_scaled(u[1], 255.0 * (double)group.whole);
    tile = ACDF_FAST_GROUP * g + acdf_fast_tile_of(mix, &group, ACDF_FAST_GROUP * g, (int32_t)y);
    mass = acdf_fast_find_tile(mix, &group, tile, &below);
    u[1] = (y - (double)below) / (double)mass;
    *part = acdf_fast_part(mix, &group, mass);
    return tile;
}

/* ---- within tiles ----------------------------------------------------------------------------------- */

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
ACDF_INLINE uint32_t acdf_fast_draw_end(const uint8_t* ends, double* u, uint32_t* steps) {
    const double z = acdf_fast_scaled(*u, 255.0);
    const uint32_t i = acdf_fast_end_of(ends, (uint32_t)(int32_t)z);
    uint32_t end;
    const uint32_t before = acdf_fast_before(ends, i, &end);
    *steps = end - before;
    *u = (z - (double)(int32_t)before) / (double)(int32_t)*steps;
    return i;
}

/* Draws a cell in a tile whose box is `range`, which becomes its own. Returns its probability there. */
ACDF_INLINE double acdf_fast_draw_cell(const AcdfFastGrid* grid, double* u, AcdfRange* range) {
    uint32_t of_line, in_line;
    const uint32_t line = acdf_fast_draw_end(grid->ends, &u[1], &of_line);
    const uint32_t cell = acdf_fast_draw_end(grid->ends + grid->count[1] + line * grid->count[0], &u[0], &in_line);
    acdf_fast_narrow(&range[0], cell, grid->shift[0]);
    acdf_fast_narrow(&range[1], line, grid->shift[1]);
    return (double)(int32_t)(of_line * in_line) * (1.0 / 65025.0);
}

/* The same of the cell that holds a square; 0 where no sample falls. */
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
    return (double)(int32_t)(of_line * in_line) * (1.0 / 65025.0);
}

#ifdef __cplusplus
}
#endif
#endif
