/* Runtime tables of boxes that rows share (acdf/blend.h): which tile holds a square, the way to each tile, and what
 * codes stand for. Flat words without pointers, which a GPU takes as they lie.
 *
 * Their results for a square are those of the traversal of the splits, to the bit. A sample is that of the
 * traversal but for the rounding of the numbers that are left of it: what the rows give to the two halves of a
 * split is summed in another order, so that a number next to a border may fall to its other side. */
#ifndef ACDF_TILE_TABLES_H
#define ACDF_TILE_TABLES_H

#include <acdf/blend.h>
#include <acdf/short_curves.h>

#ifdef __cplusplus
extern "C" {
#endif

/* Steps that a record holds; levels of splits that the first cache line of a row holds. */
enum { ACDF_TILE_STEPS = 20, ACDF_TILE_UPPER = 6 };

/* A tile, in a cache line: where it lies, and the way to it. */
typedef struct AcdfTileRecord {
    uint32_t low[2], high[2];
    uint32_t root;                  /* of its curves; ACDF_NO_ROOT: it is a cell */
    uint16_t depth;                 /* how many steps lead to it */
    uint16_t light;                 /* the number of its light and 1; 0: it has none */
    uint16_t step[ACDF_TILE_STEPS]; /* 2 * split, and 1 where it leads to the upper half; where there are more of
                                       them, the number of the first one in `paths`, lower half first */
} AcdfTileRecord;
ACDF_STATIC_ASSERT(sizeof(AcdfTileRecord) == 64);

/* Offsets are in words, from the start of all tables. Splits are numbered anew: those of the upper levels stand in
 * one cache line of a row, those below them line by line. */
typedef struct AcdfTileTables {
    uint32_t codes;    /* f64, 256 pairs: what parts a code gives to the lower and to the upper half of a split */
    uint32_t splits;   /* AcdfSplit, `stride` of them; some are none */
    uint32_t rows;     /* u8 a split of each row, `stride` bytes a row; and a line more */
    uint32_t stride;   /* a multiple of 64 */
    uint32_t root;     /* split 0, or the only tile */
    uint32_t tiles;    /* AcdfTileRecord, one a tile */
    uint32_t paths;    /* u16 a step to tiles that are deeper than ACDF_TILE_STEPS */
    uint32_t grid;     /* u16: the split or (with its flag) the tile that holds a part of the square */
    uint32_t shift[2]; /* bits of positions that are finer than the grid */
    uint32_t bits0;    /* the grid has 2^bits0 entries along axis 0, which are next to each other */
    uint32_t reserved;
} AcdfTileTables;

ACDF_INLINE const uint8_t* acdf_tile_row(const uint32_t* words, const AcdfTileTables* tables, uint32_t row) {
    return (const uint8_t*)(const void*)(words + tables->rows) + (size_t)row * tables->stride;
}
ACDF_INLINE const AcdfSplit* acdf_tile_splits(const uint32_t* words, const AcdfTileTables* tables) {
    return (const AcdfSplit*)(const void*)(words + tables->splits);
}
ACDF_INLINE const double* acdf_tile_codes(const uint32_t* words, const AcdfTileTables* tables) {
    return (const double*)(const void*)(words + tables->codes);
}
ACDF_INLINE const AcdfTileRecord* acdf_tile_record(const uint32_t* words, const AcdfTileTables* tables,
                                                   uint32_t tile) {
    return (const AcdfTileRecord*)(const void*)(words + tables->tiles) + tile;
}

ACDF_INLINE void acdf_tile_range(const AcdfTileRecord* tile, AcdfRange range[2]) {
    int i;
    for (i = 0; i < 2; ++i) {
        range[i].low = tile->low[i];
        range[i].high = tile->high[i];
    }
}

/* The tile that holds a square of the grid of positions. */
ACDF_INLINE uint32_t acdf_tile_at(const uint32_t* words, const AcdfTileTables* tables, const uint32_t* square) {
    const AcdfSplit* splits = acdf_tile_splits(words, tables);
    const uint32_t key0 = square[0] << 3 | 7u, key1 = square[1] << 3 | 7u; /* as in acdf_blend_find_rows */
    uint32_t node =
        ((const uint16_t*)(const void*)(words + tables->grid))[(square[1] >> tables->shift[1] << tables->bits0) +
                                                               (square[0] >> tables->shift[0])];
    int i;
    for (i = 0; i < 2; ++i) { /* which most need at most: nobody guesses how many it is */
        const AcdfSplit* split = &splits[node & ~(0u - (node >> 15))];
        const uint32_t place = split->place, first = key0 >= place;
        const uint32_t next = split->child[first ^ ((first ^ (key1 >= place)) & (place & 7u))];
        node ^= (node ^ next) & ((node >> 15) - 1u);
    }
    while (!(node & ACDF_TILE_FLAG)) {
        const uint32_t place = splits[node].place, first = key0 >= place;
        node = splits[node].child[first ^ ((first ^ (key1 >= place)) & (place & 7u))];
    }
    return node & ~ACDF_TILE_FLAG;
}

/* Multiplies what rows give to the halves that some steps lead to. */
ACDF_INLINE void acdf_tile_follow(const double* codes, const uint8_t* const* row, const int rows,
                                  const uint16_t* step, const uint16_t* end, double* part) {
    int i;
    for (; step < end; ++step) {
        const size_t turn = *step, split = turn >> 1, upper = turn & 1u;
        for (i = 0; i < rows; ++i) part[i] *= codes[2 * (size_t)row[i][split] + upper];
    }
}

/* The share of a mixture that reaches a tile: the products of acdf_blend_find_rows from step `first` on.
 * Tiles below a horizon are mostly found by the upper splits, so that the rest of their rows is not waited for. */
ACDF_INLINE double acdf_tile_share_rows(const uint32_t* words, const AcdfTileTables* tables, const AcdfMixture* mix,
                                        const uint8_t* const* row, const int rows, const AcdfTileRecord* tile,
                                        uint32_t first) {
    const double* codes = acdf_tile_codes(words, tables);
    const uint32_t depth = tile->depth, most = ACDF_TILE_UPPER, upper = depth < most ? depth : most;
    const uint16_t* step = tile->step;
    double part[ACDF_MAX_ROWS_MIXED], sum = 0.0;
    int i;
    if (depth > ACDF_TILE_STEPS)
        step = (const uint16_t*)(const void*)(words + tables->paths) + (step[0] | (uint32_t)step[1] << 16);
    for (i = 0; i < rows; ++i) part[i] = 1.0;
    acdf_tile_follow(codes, row, rows, step + first, step + upper, part);
    for (i = 0; i < rows; ++i) sum += part[i];
    if (!(sum > 0.0)) return 0.0;
    acdf_tile_follow(codes, row, rows, step + (first > upper ? first : upper), step + depth, part);
    return acdf_mixture_of(mix, rows, part);
}

/* A traversal of the splits on the way to a tile, as in acdf_blend_sample_rows, by random numbers that are given as
 * what x they are of all that the mixture gives. No branch depends on what is sampled but where the way ends. Rows
 * are as many as in all three functions. */
#ifdef ACDF_SSE2
typedef struct AcdfTileWalk {
    __m128d weight[ACDF_MAX_ROWS_MIXED]; /* and part */
    __m128d code[ACDF_MAX_ROWS_MIXED];   /* what each row gives to the halves of the split */
    __m128d x, chosen;
    uint64_t split;
    uint32_t node;
} AcdfTileWalk;

ACDF_INLINE __m128d acdf_either(__m128d mask, __m128d no, __m128d yes) {
    return _mm_or_pd(_mm_and_pd(mask, yes), _mm_andnot_pd(mask, no));
}
ACDF_INLINE __m128d acdf_tile_code(const double* codes, const uint8_t* row, uint32_t split) {
    return _mm_load_pd(codes + 2 * (size_t)row[split]);
}
ACDF_INLINE void acdf_tile_walk_begin(const uint32_t* words, const AcdfTileTables* tables, const AcdfMixture* mix,
                                      const uint8_t* const* row, const int rows, uint32_t node, const double* from,
                                      AcdfTileWalk* walk) {
    const double* codes = acdf_tile_codes(words, tables);
    int i;
    walk->chosen = _mm_set1_pd(acdf_mixture_sum(mix));
    walk->x = _mm_set_pd(from[1], from[0]);
    walk->split = ((const uint64_t*)(const void*)acdf_tile_splits(words, tables))[node];
    walk->node = node;
    for (i = 0; i < rows; ++i) {
        walk->weight[i] = _mm_set_pd(1.0, mix->weight[i]);
        walk->code[i] = acdf_tile_code(codes, row[i], node);
    }
}
/* All of both halves is loaded and computed before it is known which one is taken: else all wait for each other,
 * from a byte of a row to the place of the next one. What waits for the decision is chosen by its mask. */
ACDF_INLINE void acdf_tile_walk_step(const uint32_t* words, const AcdfTileTables* tables, const uint8_t* const* row,
                                     const int rows, AcdfTileWalk* walk) {
    const double* codes = acdf_tile_codes(words, tables);
    const uint64_t* splits = (const uint64_t*)(const void*)acdf_tile_splits(words, tables);
    const uint64_t split = walk->split;
    const int64_t axis = (int64_t)(split & 1u);
    const __m128d along = _mm_castsi128_pd(_mm_set_epi64x(-axis, axis - 1));
    /* Of a tile any other split's, which is not used. */
    const uint32_t next0 = (uint32_t)(split >> 32) & 0x7FFFu, next1 = (uint32_t)(split >> 48) & 0x7FFFu;
    const uint64_t split0 = splits[next0], split1 = splits[next1];
    __m128d low[ACDF_MAX_ROWS_MIXED], high[ACDF_MAX_ROWS_MIXED], lower, upper, part, in_upper;
    uint64_t mask;
    int i;
    for (i = 0; i < rows; ++i) {
        low[i] = _mm_mul_pd(walk->weight[i], _mm_unpacklo_pd(walk->code[i], walk->code[i]));
        high[i] = _mm_mul_pd(walk->weight[i], _mm_unpackhi_pd(walk->code[i], walk->code[i]));
    }
    lower = low[0];
    upper = high[0];
    for (i = 1; i < rows; ++i) {
        lower = _mm_add_pd(lower, low[i]);
        upper = _mm_add_pd(upper, high[i]);
    }
    part = _mm_div_pd(_mm_unpacklo_pd(lower, upper), walk->chosen);
    lower = _mm_unpacklo_pd(lower, lower);
    upper = _mm_unpacklo_pd(upper, upper);
    in_upper = _mm_and_pd(_mm_and_pd(_mm_cmpnlt_pd(walk->x, lower), _mm_cmplt_pd(_mm_setzero_pd(), upper)), along);
    in_upper = _mm_or_pd(in_upper, _mm_shuffle_pd(in_upper, in_upper, 1));
    for (i = 0; i < rows; ++i) {
        walk->weight[i] = acdf_either(in_upper, low[i], high[i]);
        walk->code[i] =
            acdf_either(in_upper, acdf_tile_code(codes, row[i], next0), acdf_tile_code(codes, row[i], next1));
    }
    part = acdf_either(in_upper, _mm_unpacklo_pd(part, part), _mm_unpackhi_pd(part, part));
    walk->x = _mm_sub_pd(walk->x, _mm_and_pd(_mm_and_pd(in_upper, along), lower));
    walk->x = _mm_mul_pd(walk->x, acdf_either(along, part, _mm_set1_pd(1.0)));
    walk->chosen = acdf_either(in_upper, lower, upper);
    mask = 0 - (uint64_t)((uint32_t)_mm_movemask_pd(in_upper) & 1u);
    walk->node = (uint32_t)(split >> (32 + (16 & mask))) & 0xFFFFu;
    walk->split = split0 ^ ((split0 ^ split1) & mask);
}
/* u becomes what is left of the random numbers, *given what the mixture gives to the tile. Returns its number. */
ACDF_INLINE uint32_t acdf_tile_walk_end(const AcdfTileWalk* walk, const AcdfMixture* mix, const int rows, double* u,
                                        double* given) {
    const __m128d one = _mm_set1_pd(1.0), left = _mm_max_pd(_mm_div_pd(walk->x, walk->chosen), _mm_setzero_pd());
    double part[ACDF_MAX_ROWS_MIXED];
    int i;
    _mm_storeu_pd(u, acdf_either(_mm_cmplt_pd(walk->x, walk->chosen), one, left));
    for (i = 0; i < rows; ++i) _mm_storeh_pd(&part[i], walk->weight[i]);
    *given = acdf_mixture_of(mix, rows, part);
    return walk->node & ~ACDF_TILE_FLAG;
}
#else
typedef struct AcdfTileWalk {
    double weight[ACDF_MAX_ROWS_MIXED], part[ACDF_MAX_ROWS_MIXED], x[2], chosen;
    uint32_t node;
} AcdfTileWalk;

ACDF_INLINE void acdf_tile_walk_begin(const uint32_t* words, const AcdfTileTables* tables, const AcdfMixture* mix,
                                      const uint8_t* const* row, const int rows, uint32_t node, const double* from,
                                      AcdfTileWalk* walk) {
    int i;
    (void)words;
    (void)tables;
    (void)row;
    walk->chosen = acdf_mixture_sum(mix);
    walk->node = node;
    for (i = 0; i < 2; ++i) walk->x[i] = from[i];
    for (i = 0; i < rows; ++i) {
        walk->weight[i] = mix->weight[i];
        walk->part[i] = 1.0;
    }
}
ACDF_INLINE void acdf_tile_walk_step(const uint32_t* words, const AcdfTileTables* tables, const uint8_t* const* row,
                                     const int rows, AcdfTileWalk* walk) {
    const double* codes = acdf_tile_codes(words, tables);
    const uint32_t node = walk->node;
    const AcdfSplit* split = &acdf_tile_splits(words, tables)[node];
    const uint32_t axis = split->place & 1u;
    double half[2] = {0.0, 0.0}, below[2] = {0.0, 0.0};
    uint32_t upper;
    int i;
    for (i = 0; i < rows; ++i) {
        half[0] += walk->weight[i] * codes[2 * row[i][node]];
        half[1] += walk->weight[i] * codes[2 * row[i][node] + 1];
    }
    below[1] = half[0];
    upper = (uint32_t) !(walk->x[axis] < half[0]) & (uint32_t)(half[1] > 0.0);
    for (i = 0; i < rows; ++i) {
        walk->weight[i] *= codes[2 * row[i][node] + upper];
        walk->part[i] *= codes[2 * row[i][node] + upper];
    }
    walk->x[axis] -= below[upper];
    walk->x[axis ^ 1u] *= half[upper] / walk->chosen;
    walk->chosen = half[upper];
    walk->node = split->child[upper];
}
ACDF_INLINE uint32_t acdf_tile_walk_end(const AcdfTileWalk* walk, const AcdfMixture* mix, const int rows, double* u,
                                        double* given) {
    int i;
    for (i = 0; i < 2; ++i)
        u[i] = walk->x[i] < walk->chosen ? (walk->x[i] > 0.0 ? walk->x[i] / walk->chosen : 0.0) : 1.0;
    *given = acdf_mixture_of(mix, rows, walk->part);
    return walk->node & ~ACDF_TILE_FLAG;
}
#endif

/* Samples a tile below split `node`: u and *given as acdf_tile_walk_end sets them. */
ACDF_INLINE uint32_t acdf_tile_sample_rows(const uint32_t* words, const AcdfTileTables* tables,
                                           const AcdfMixture* mix, const uint8_t* const* row, const int rows,
                                           uint32_t node, const double* from, double* u, double* given) {
    AcdfTileWalk walk;
    acdf_tile_walk_begin(words, tables, mix, row, rows, node, from, &walk);
    do {
        acdf_tile_walk_step(words, tables, row, rows, &walk);
    } while (!(walk.node & ACDF_TILE_FLAG));
    return acdf_tile_walk_end(&walk, mix, rows, u, given);
}

/* The same for any number of rows, and where the node is a tile (with its flag). */
ACDF_INLINE double acdf_tile_share(const uint32_t* words, const AcdfTileTables* tables, const AcdfMixture* mix,
                                   const uint8_t* const* row, const AcdfTileRecord* tile, uint32_t first) {
    switch (mix->count) {
    case 3:
        return acdf_tile_share_rows(words, tables, mix, row, 3, tile, first);
    default:
        return acdf_tile_share_rows(words, tables, mix, row, mix->count, tile, first);
    }
}
ACDF_INLINE uint32_t acdf_tile_sample(const uint32_t* words, const AcdfTileTables* tables, const AcdfMixture* mix,
                                      const uint8_t* const* row, uint32_t node, const double* from, double* u,
                                      double* given) {
    int i;
    if (node & ACDF_TILE_FLAG) {
        *given = acdf_mixture_sum(mix);
        for (i = 0; i < 2; ++i) u[i] = acdf_unit_interval(from[i] / *given);
        return node & ~ACDF_TILE_FLAG;
    }
    switch (mix->count) {
    case 1:
        return acdf_tile_sample_rows(words, tables, mix, row, 1, node, from, u, given);
    case 2:
        return acdf_tile_sample_rows(words, tables, mix, row, 2, node, from, u, given);
    default:
        return acdf_tile_sample_rows(words, tables, mix, row, 3, node, from, u, given);
    }
}

#ifdef __cplusplus
}
#endif
#endif
