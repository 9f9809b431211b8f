/* Which cells may hold a point of a square: a grid whose entries name blocks of up to 16 boxes, found without a
 * branch on the data. Plain words that a GPU takes as they lie.
 *
 * The two keys of a point are integers. A block covers a rectangle that halving the square gives, and says where
 * in it each of its cells lies in steps of 1/256: what it names may hold the point, and one of them does. Whoever
 * asks looks at the cell itself. Where a rectangle as small as an entry of the grid has too many cells, a finer
 * grid of 8 x 8 entries takes its place. */
#ifndef ACDF_SQUARES_H
#define ACDF_SQUARES_H

#include <acdf/elementary.h>
#include <acdf/layout.h>

#ifdef __cplusplus
extern "C" {
#endif

/* Offsets are in words, from the start of all tables. */
typedef struct AcdfSquares {
    uint32_t shift0; /* bits of key 0 that are finer than the grid */
    uint32_t shift1;
    uint32_t bits0; /* the grid has 2^bits0 entries along key 0, which are next to each other */
    uint32_t bits1;
    uint32_t grid;   /* entries */
    uint32_t finer;  /* grids of 16 entries */
    uint32_t boxes;  /* 16 words a block: bytes low 0, high 0, low 1, high 1 of each cell, less 128 */
    uint32_t cells;  /* 8 words a block: 16 numbers of cells */
    uint32_t blocks; /* how many there are; block 0 names none */
} AcdfSquares;

enum { ACDF_BLOCK_CELLS = 16 };

/* An entry: shifts of both keys (5 bits each) and the number of a block; or the flag, and of a finer grid the bits
 * along key 0 (3 bits) and the number. */
#define ACDF_SQUARES_FINER 0x80000000u
#define ACDF_SQUARES_BLOCK_BITS 21u
#define ACDF_SQUARES_BLOCK_MASK 0x001FFFFFu
#define ACDF_FINER_BITS 4u

/* The entry of a point. */
ACDF_INLINE uint32_t acdf_squares_entry(const uint32_t* tables, const AcdfSquares* squares, uint32_t key0,
                                        uint32_t key1) {
    uint32_t shift0 = squares->shift0, shift1 = squares->shift1;
    uint32_t entry = tables[squares->grid + ((key1 >> shift1) << squares->bits0) + (key0 >> shift0)];
    while (entry & ACDF_SQUARES_FINER) {
        const uint32_t bits0 = entry >> 28 & 7u, bits1 = ACDF_FINER_BITS - bits0;
        shift0 -= bits0;
        shift1 -= bits1;
        entry =
            tables[squares->finer + (entry & 0x0FFFFFFFu) * 16u +
                   (((key1 >> shift1 & ((1u << bits1) - 1u)) << bits0) | (key0 >> shift0 & ((1u << bits0) - 1u)))];
    }
    return entry;
}

/* The highest bit of each byte: whether that of a is at least that of b; bytes are signed. */
ACDF_INLINE uint32_t acdf_bytes_reach(uint32_t a, uint32_t b) {
    const uint32_t difference = (a | 0x80808080u) - (b & 0x7F7F7F7Fu);
    return (~a & b) | (~(a ^ b) & difference);
}
/* Whether each byte of a position lies from low to high, as the highest bit of that byte. */
ACDF_INLINE uint32_t acdf_bytes_within(uint32_t place, uint32_t low, uint32_t high) {
    return acdf_bytes_reach(place, low) & acdf_bytes_reach(high, place);
}
/* The highest bits of four bytes as the four lowest bits: no sum of the product carries. */
ACDF_INLINE uint32_t acdf_four_bits(uint32_t bytes) { return (bytes >> 7 & 0x01010101u) * 0x01020408u >> 24; }
/* A byte four times, less 128 as those of boxes are. */
ACDF_INLINE uint32_t acdf_four_bytes(uint32_t number) { return (number ^ 0x80u) * 0x01010101u; }

/* Bit i: whether cell i of the block of these boxes may hold the point; never of those that it lacks. */
ACDF_INLINE uint32_t acdf_boxes_around(const uint32_t* boxes, uint32_t byte0, uint32_t byte1) {
    const uint32_t place0 = acdf_four_bytes(byte0), place1 = acdf_four_bytes(byte1);
    uint32_t mask = 0, word;
    for (word = 0; word < 4; ++word) {
        const uint32_t within0 = acdf_bytes_within(place0, boxes[word], boxes[word + 4]);
        const uint32_t within1 = acdf_bytes_within(place1, boxes[word + 8], boxes[word + 12]);
        mask |= acdf_four_bits(within0 & within1) << (word * 4);
    }
    return mask;
}

#ifdef ACDF_SSE2
/* Bit i: whether the i-th of sixteen boxes, in bytes less 128, holds the bytes of a position. */
ACDF_INLINE uint32_t acdf_boxes_by_vectors(__m128i low0, __m128i high0, __m128i low1, __m128i high1, uint32_t byte0,
                                           uint32_t byte1) {
    const __m128i at0 = _mm_set1_epi8((char)(byte0 ^ 0x80u)), at1 = _mm_set1_epi8((char)(byte1 ^ 0x80u));
    const __m128i out0 = _mm_or_si128(_mm_cmpgt_epi8(low0, at0), _mm_cmpgt_epi8(at0, high0));
    const __m128i out1 = _mm_or_si128(_mm_cmpgt_epi8(low1, at1), _mm_cmpgt_epi8(at1, high1));
    return (uint32_t)_mm_movemask_epi8(_mm_or_si128(out0, out1)) ^ 0xFFFFu;
}
#endif

/* Bit i: whether cell i of a block may hold the point; never of those that it lacks. */
ACDF_INLINE uint32_t acdf_squares_candidates(const uint32_t* boxes, uint32_t byte0, uint32_t byte1) {
#ifdef ACDF_SSE2
    const __m128i* box = (const __m128i*)(const void*)boxes;
    return acdf_boxes_by_vectors(_mm_load_si128(box), _mm_load_si128(box + 1), _mm_load_si128(box + 2),
                                 _mm_load_si128(box + 3), byte0, byte1);
#elif defined(ACDF_ON_GPU)
    const AcdfFourWords* box = (const AcdfFourWords*)(const void*)boxes;
    const AcdfFourWords low0 = box[0], high0 = box[1], low1 = box[2], high1 = box[3];
    const uint32_t at0 = acdf_four_bytes(byte0), at1 = acdf_four_bytes(byte1);
    const uint32_t x = acdf_bytes_within(at0, low0.x, high0.x) & acdf_bytes_within(at1, low1.x, high1.x);
    const uint32_t y = acdf_bytes_within(at0, low0.y, high0.y) & acdf_bytes_within(at1, low1.y, high1.y);
    const uint32_t z = acdf_bytes_within(at0, low0.z, high0.z) & acdf_bytes_within(at1, low1.z, high1.z);
    const uint32_t w = acdf_bytes_within(at0, low0.w, high0.w) & acdf_bytes_within(at1, low1.w, high1.w);
    return acdf_four_bits(x) | acdf_four_bits(y) << 4 | acdf_four_bits(z) << 8 | acdf_four_bits(w) << 12;
#else
    return acdf_boxes_around(boxes, byte0, byte1);
#endif
}

/* Number of the lowest bit that is set; one is. */
ACDF_INLINE uint32_t acdf_lowest_bit(uint32_t mask) {
#if defined(ACDF_ON_GPU) && defined(__NVCC__)
    return (uint32_t)__ffs((int)mask) - 1u;
#elif defined(__GNUC__)
    return (uint32_t)__builtin_ctz(mask);
#else
    uint32_t i = 0;
    while (!(mask >> i & 1u)) ++i;
    return i;
#endif
}

/* The cells that may hold a point: *cells[i] for each bit i that is set in what is returned. */
ACDF_INLINE uint32_t acdf_squares_find(const uint32_t* tables, const AcdfSquares* squares, uint32_t key0,
                                       uint32_t key1, const uint16_t** cells) {
    const uint32_t entry = acdf_squares_entry(tables, squares, key0, key1);
    const uint32_t block = entry & ACDF_SQUARES_BLOCK_MASK;
    const uint32_t byte0 = key0 >> (entry >> 26) & 0xFFu, byte1 = key1 >> (entry >> 21 & 31u) & 0xFFu;
    *cells = (const uint16_t*)(const void*)(tables + squares->cells + 8u * block);
    ACDF_PREFETCH(*cells);
    return acdf_squares_candidates(tables + squares->boxes + 16u * block, byte0, byte1);
}

#ifdef __cplusplus
}
#endif
#endif
