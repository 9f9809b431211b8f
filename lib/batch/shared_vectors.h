// Vectors of ACDF_WIDTH doubles, or of twice as many floats, and what their instructions are called. Compiled once
// for each set of instructions, with internal linkage, so that no linker mixes them.
#pragma once

#include <acdf/cells.h>

#include <immintrin.h>

#include <cstddef>
#include <cstdint>

namespace {

constexpr std::size_t kLanes = 2 * ACDF_WIDTH;

typedef float Floats __attribute__((vector_size(8 * ACDF_WIDTH)));
typedef std::int32_t Signed __attribute__((vector_size(8 * ACDF_WIDTH))); // also masks: all ones or 0
typedef std::uint32_t Words __attribute__((vector_size(8 * ACDF_WIDTH)));
typedef double Doubles __attribute__((vector_size(8 * ACDF_WIDTH)));
typedef std::uint64_t Longs __attribute__((vector_size(8 * ACDF_WIDTH)));
typedef float HalfFloats __attribute__((vector_size(4 * ACDF_WIDTH)));
typedef std::int32_t HalfSigned __attribute__((vector_size(4 * ACDF_WIDTH)));

#define ACDF_LANE static inline __attribute__((always_inline))

#if ACDF_WIDTH == 8
ACDF_LANE Floats root(Floats x) { return (Floats)_mm512_sqrt_ps((__m512)x); }
ACDF_LANE std::uint32_t bits(Signed mask) { return (std::uint32_t)_mm512_movepi32_mask((__m512i)mask); }
ACDF_LANE Words gathered(const std::uint32_t* base, Words at) {
    return (Words)_mm512_i32gather_epi32((__m512i)at, base, 4);
}
ACDF_LANE Words shifted_right(Words x, Words by) { return (Words)_mm512_srlv_epi32((__m512i)x, (__m512i)by); }
ACDF_LANE Words low_words(Longs a, Longs b) {
    return (Words)_mm512_inserti64x4(_mm512_castsi256_si512(_mm512_cvtepi64_epi32((__m512i)a)),
                                     _mm512_cvtepi64_epi32((__m512i)b), 1);
}
ACDF_LANE Doubles to_doubles(Signed x, int half) {
    return (Doubles)_mm512_cvtepi32_pd(half ? _mm512_extracti64x4_epi64((__m512i)x, 1)
                                            : _mm512_castsi512_si256((__m512i)x));
}
ACDF_LANE Floats to_floats(Doubles a, Doubles b) {
    return (Floats)_mm512_insertf32x8(_mm512_castps256_ps512(_mm512_cvtpd_ps((__m512d)a)),
                                      _mm512_cvtpd_ps((__m512d)b), 1);
}
/* The first and the second of each of ACDF_WIDTH pairs. */
ACDF_LANE void load_pairs(const double (*u)[2], Doubles out[2]) {
    const __m512d a = _mm512_loadu_pd(u[0]), b = _mm512_loadu_pd(u[4]);
    out[0] = (Doubles)_mm512_permutex2var_pd(a, _mm512_setr_epi64(0, 2, 4, 6, 8, 10, 12, 14), b);
    out[1] = (Doubles)_mm512_permutex2var_pd(a, _mm512_setr_epi64(1, 3, 5, 7, 9, 11, 13, 15), b);
}
/* Four floats at `from`, and at each next multiple of `stride` floats. */
ACDF_LANE Floats load_fours(const float* from, std::size_t stride) {
    const __m256 low = _mm256_set_m128(_mm_loadu_ps(from + stride), _mm_loadu_ps(from));
    const __m256 high = _mm256_set_m128(_mm_loadu_ps(from + 3 * stride), _mm_loadu_ps(from + 2 * stride));
    return (Floats)_mm512_insertf32x8(_mm512_castps256_ps512(low), high, 1);
}
template <int Order>
ACDF_LANE Floats shuffled(Floats a, Floats b) {
    return (Floats)_mm512_shuffle_ps((__m512)a, (__m512)b, Order);
}
ACDF_LANE Floats unpacked_low(Floats a, Floats b) { return (Floats)_mm512_unpacklo_ps((__m512)a, (__m512)b); }
ACDF_LANE Floats unpacked_high(Floats a, Floats b) { return (Floats)_mm512_unpackhi_ps((__m512)a, (__m512)b); }
/* The first half of both, and the second. */
ACDF_LANE Floats low_fours(Floats a, Floats b) { return (Floats)_mm512_shuffle_f32x4((__m512)a, (__m512)b, 0x44); }
ACDF_LANE Floats high_fours(Floats a, Floats b) { return (Floats)_mm512_shuffle_f32x4((__m512)a, (__m512)b, 0xEE); }
/* Every second group of four floats of both. */
ACDF_LANE Floats even_fours(Floats a, Floats b) { return (Floats)_mm512_shuffle_f32x4((__m512)a, (__m512)b, 0x88); }
ACDF_LANE Floats odd_fours(Floats a, Floats b) { return (Floats)_mm512_shuffle_f32x4((__m512)a, (__m512)b, 0xDD); }
/* Four floats of each row, from row to row, then the four after them, and so on. */
ACDF_LANE void store_rows(const Floats row[4], float* out) {
    const Floats low[2] = {low_fours(row[0], row[1]), low_fours(row[2], row[3])};
    const Floats high[2] = {high_fours(row[0], row[1]), high_fours(row[2], row[3])};
    _mm512_storeu_ps(out, (__m512)even_fours(low[0], low[1]));
    _mm512_storeu_ps(out + 16, (__m512)odd_fours(low[0], low[1]));
    _mm512_storeu_ps(out + 32, (__m512)even_fours(high[0], high[1]));
    _mm512_storeu_ps(out + 48, (__m512)odd_fours(high[0], high[1]));
}
#else
ACDF_LANE Floats root(Floats x) { return (Floats)_mm256_sqrt_ps((__m256)x); }
ACDF_LANE std::uint32_t bits(Signed mask) { return (std::uint32_t)_mm256_movemask_ps((__m256)mask); }
ACDF_LANE Words gathered(const std::uint32_t* base, Words at) {
    return (Words)_mm256_i32gather_epi32((const int*)base, (__m256i)at, 4);
}
ACDF_LANE Words shifted_right(Words x, Words by) { return (Words)_mm256_srlv_epi32((__m256i)x, (__m256i)by); }
ACDF_LANE Words low_words(Longs a, Longs b) {
    const __m256 even = _mm256_shuffle_ps((__m256)a, (__m256)b, 0x88);
    return (Words)_mm256_permute4x64_pd(_mm256_castps_pd(even), 0xD8);
}
ACDF_LANE Doubles to_doubles(Signed x, int half) {
    return (Doubles)_mm256_cvtepi32_pd(half ? _mm256_extracti128_si256((__m256i)x, 1)
                                            : _mm256_castsi256_si128((__m256i)x));
}
ACDF_LANE Floats to_floats(Doubles a, Doubles b) {
    return (Floats)_mm256_set_m128(_mm256_cvtpd_ps((__m256d)b), _mm256_cvtpd_ps((__m256d)a));
}
ACDF_LANE void load_pairs(const double (*u)[2], Doubles out[2]) {
    const __m256d a = _mm256_loadu_pd(u[0]), b = _mm256_loadu_pd(u[2]);
    out[0] = (Doubles)_mm256_permute4x64_pd(_mm256_unpacklo_pd(a, b), 0xD8);
    out[1] = (Doubles)_mm256_permute4x64_pd(_mm256_unpackhi_pd(a, b), 0xD8);
}
ACDF_LANE Floats load_fours(const float* from, std::size_t stride) {
    return (Floats)_mm256_set_m128(_mm_loadu_ps(from + stride), _mm_loadu_ps(from));
}
template <int Order>
ACDF_LANE Floats shuffled(Floats a, Floats b) {
    return (Floats)_mm256_shuffle_ps((__m256)a, (__m256)b, Order);
}
ACDF_LANE Floats unpacked_low(Floats a, Floats b) { return (Floats)_mm256_unpacklo_ps((__m256)a, (__m256)b); }
ACDF_LANE Floats unpacked_high(Floats a, Floats b) { return (Floats)_mm256_unpackhi_ps((__m256)a, (__m256)b); }
ACDF_LANE Floats even_fours(Floats a, Floats b) {
    return (Floats)_mm256_permute2f128_ps((__m256)a, (__m256)b, 0x20);
}
ACDF_LANE Floats odd_fours(Floats a, Floats b) {
    return (Floats)_mm256_permute2f128_ps((__m256)a, (__m256)b, 0x31);
}
ACDF_LANE void store_rows(const Floats row[4], float* out) {
    _mm256_storeu_ps(out, (__m256)even_fours(row[0], row[1]));
    _mm256_storeu_ps(out + 8, (__m256)even_fours(row[2], row[3]));
    _mm256_storeu_ps(out + 16, (__m256)odd_fours(row[0], row[1]));
    _mm256_storeu_ps(out + 24, (__m256)odd_fours(row[2], row[3]));
}
#endif

ACDF_LANE Floats select(Signed mask, Floats yes, Floats no) {
    return (Floats)(((Signed)yes & mask) | ((Signed)no & ~mask));
}
ACDF_LANE Floats absolute(Floats x) { return (Floats)((Words)x & 0x7FFFFFFFu); }
/* ACDF_MIN, ACDF_MAX: b, too, where both are 0 or either is NaN. */
#if ACDF_WIDTH == 8
ACDF_LANE Floats least(Floats a, Floats b) { return (Floats)_mm512_min_ps((__m512)a, (__m512)b); }
ACDF_LANE Floats most(Floats a, Floats b) { return (Floats)_mm512_max_ps((__m512)a, (__m512)b); }
#else
ACDF_LANE Floats least(Floats a, Floats b) { return (Floats)_mm256_min_ps((__m256)a, (__m256)b); }
ACDF_LANE Floats most(Floats a, Floats b) { return (Floats)_mm256_max_ps((__m256)a, (__m256)b); }
#endif

/* x, y and z of each lane's vector. */
ACDF_LANE void load_vectors(const float (*w)[3], Floats out[3]) {
    const auto* const all = (const float*)w;
    const Floats a = load_fours(all, 12), b = load_fours(all + 4, 12), c = load_fours(all + 8, 12);
    const Floats xy = shuffled<_MM_SHUFFLE(2, 1, 3, 2)>(b, c), yz = shuffled<_MM_SHUFFLE(1, 0, 2, 1)>(a, b);
    out[0] = shuffled<_MM_SHUFFLE(2, 0, 3, 0)>(a, xy);
    out[1] = shuffled<_MM_SHUFFLE(3, 1, 2, 0)>(yz, xy);
    out[2] = shuffled<_MM_SHUFFLE(3, 0, 3, 1)>(yz, c);
}

ACDF_LANE void store_samples(const Floats direction[3], Floats pdf, AcdfDirectionSample* out) {
    const Floats xy[2] = {unpacked_low(direction[0], direction[1]), unpacked_high(direction[0], direction[1])};
    const Floats zp[2] = {unpacked_low(direction[2], pdf), unpacked_high(direction[2], pdf)};
    const Floats row[4] = {
        /* lane k of each four */
        shuffled<_MM_SHUFFLE(1, 0, 1, 0)>(xy[0], zp[0]), shuffled<_MM_SHUFFLE(3, 2, 3, 2)>(xy[0], zp[0]),
        shuffled<_MM_SHUFFLE(1, 0, 1, 0)>(xy[1], zp[1]), shuffled<_MM_SHUFFLE(3, 2, 3, 2)>(xy[1], zp[1])};
    store_rows(row, (float*)out);
}

} // namespace
