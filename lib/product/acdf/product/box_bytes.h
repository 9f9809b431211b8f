/* Sixteen boxes of bytes at once, and which of them hold a point: without a branch on the data. */
#ifndef ACDF_BOX_BYTES_H
#define ACDF_BOX_BYTES_H

#include <acdf/elementary.h>

#ifdef __cplusplus
extern "C" {
#endif

enum { ACDF_BLOCK_BOXES = 16 };

/* A block has 16 words: bytes low 0, high 0, low 1, high 1 of each box, less 128. */

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

/* Bit i: whether box i of a block holds the bytes of a position. */
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
/* Bit i: whether the i-th of sixteen boxes holds the bytes of a position. */
ACDF_INLINE uint32_t acdf_boxes_by_vectors(__m128i low0, __m128i high0, __m128i low1, __m128i high1, uint32_t byte0,
                                           uint32_t byte1) {
    const __m128i at0 = _mm_set1_epi8((char)(byte0 ^ 0x80u)), at1 = _mm_set1_epi8((char)(byte1 ^ 0x80u));
    const __m128i out0 = _mm_or_si128(_mm_cmpgt_epi8(low0, at0), _mm_cmpgt_epi8(at0, high0));
    const __m128i out1 = _mm_or_si128(_mm_cmpgt_epi8(low1, at1), _mm_cmpgt_epi8(at1, high1));
    return (uint32_t)_mm_movemask_epi8(_mm_or_si128(out0, out1)) ^ 0xFFFFu;
}
#endif

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

#ifdef __cplusplus
}
#endif
#endif
