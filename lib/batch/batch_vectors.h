// Vectors of ACDF_WIDTH doubles, by the extensions of GCC and Clang, and what they need the processor's own names
// for. Nothing here may be inline with external linkage: see brdf_kernel.h.
#pragma once

#include <acdf/sphere.h>

#include <immintrin.h>

#include <cstdint>

namespace {

constexpr int kWidth = ACDF_WIDTH;

typedef double Vector __attribute__((vector_size(8 * ACDF_WIDTH)));
typedef long long Integer __attribute__((vector_size(8 * ACDF_WIDTH))); // also masks: all ones or 0
typedef unsigned long long Unsigned __attribute__((vector_size(8 * ACDF_WIDTH)));

#define ACDF_LANE static inline __attribute__((always_inline))
#define ACDF_LANE_MEMBER __attribute__((always_inline))

// ---- what the instructions are called --------------------------------------------------------------------------

/* Addresses base + Scale * index are taken from memory: the instructions that gather take longer on several
 * processors, and so does to take an index out of a register. */
struct Indices {
    alignas(8 * ACDF_WIDTH) long long at[ACDF_WIDTH];
};
ACDF_LANE void stored(Indices* to, Integer index) {
    *(Integer*)to->at = index;
    asm("" : "+m"(*to)); // or compilers take them out of the register
}

/* Eight bytes at base + Scale * index. */
template <int Scale>
ACDF_LANE Integer gathered(const void* base, Integer index) {
    Indices lanes;
    stored(&lanes, index);
    const char* const bytes = (const char*)base;
    __m128d pair[ACDF_WIDTH / 2];
    for (int i = 0; i < ACDF_WIDTH / 2; ++i) {
        const __m128d low = _mm_load_sd((const double*)(bytes + Scale * lanes.at[2 * i]));
        pair[i] = _mm_loadh_pd(low, (const double*)(bytes + Scale * lanes.at[2 * i + 1]));
    }
#if ACDF_WIDTH == 8
    const __m256d low = _mm256_set_m128d(pair[1], pair[0]), high = _mm256_set_m128d(pair[3], pair[2]);
    return (Integer)_mm512_insertf64x4(_mm512_castpd256_pd512(low), high, 1);
#else
    return (Integer)_mm256_set_m128d(pair[1], pair[0]);
#endif
}

/* The two doubles at each address. */
#if ACDF_WIDTH == 8
ACDF_LANE void gather_pairs(const double* const* at, Vector out[2]) {
    __m512d half[2]; // of even and of odd lanes
    for (int i = 0; i < 2; ++i) {
        half[i] = _mm512_castpd128_pd512(_mm_loadu_pd(at[i]));
        half[i] = _mm512_insertf64x2(half[i], _mm_loadu_pd(at[2 + i]), 1);
        half[i] = _mm512_insertf64x2(half[i], _mm_loadu_pd(at[4 + i]), 2);
        half[i] = _mm512_insertf64x2(half[i], _mm_loadu_pd(at[6 + i]), 3);
    }
    out[0] = (Vector)_mm512_unpacklo_pd(half[0], half[1]);
    out[1] = (Vector)_mm512_unpackhi_pd(half[0], half[1]);
}
#else
ACDF_LANE void gather_pairs(const double* const* at, Vector out[2]) {
    const __m256d even = _mm256_set_m128d(_mm_loadu_pd(at[2]), _mm_loadu_pd(at[0]));
    const __m256d odd = _mm256_set_m128d(_mm_loadu_pd(at[3]), _mm_loadu_pd(at[1]));
    out[0] = (Vector)_mm256_unpacklo_pd(even, odd);
    out[1] = (Vector)_mm256_unpackhi_pd(even, odd);
}
#endif
/* Eight bytes at base + Scale * index, and the eight behind them. */
template <int Scale>
ACDF_LANE void gather_pairs(const void* base, Integer index, Vector out[2]) {
    Indices lanes;
    stored(&lanes, index);
    const double* at[ACDF_WIDTH];
    for (int i = 0; i < ACDF_WIDTH; ++i) at[i] = (const double*)((const char*)base + Scale * lanes.at[i]);
    gather_pairs(at, out);
}

#if ACDF_WIDTH == 8
ACDF_LANE Integer least(Integer a, Integer b) { return (Integer)_mm512_min_epi64((__m512i)a, (__m512i)b); }
ACDF_LANE Integer most(Integer a, Integer b) { return (Integer)_mm512_max_epi64((__m512i)a, (__m512i)b); }
ACDF_LANE Vector root(Vector x) { return (Vector)_mm512_sqrt_pd((__m512d)x); }
ACDF_LANE Vector rounded_to_float(Vector x) { return (Vector)_mm512_cvtps_pd(_mm512_cvtpd_ps((__m512d)x)); }
ACDF_LANE Integer truncated(Vector x) { return (Integer)_mm512_cvttpd_epi64((__m512d)x); }
ACDF_LANE Vector converted(Integer i) { return (Vector)_mm512_cvtepi64_pd((__m512i)i); }
ACDF_LANE unsigned bits(Integer mask) { return _mm512_movepi64_mask((__m512i)mask); }
ACDF_LANE void load_transposed(const float (*v)[3], Vector out[3]) {
    const float* floats = (const float*)v;
    const __m512 first = _mm512_loadu_ps(floats), last = _mm512_castps256_ps512(_mm256_loadu_ps(floats + 16));
    const __m512i third = _mm512_setr_epi32(0, 3, 6, 9, 12, 15, 18, 21, 0, 0, 0, 0, 0, 0, 0, 0);
    for (int i = 0; i < 3; ++i) {
        const __m512 axis = _mm512_permutex2var_ps(first, _mm512_add_epi32(third, _mm512_set1_epi32(i)), last);
        out[i] = (Vector)_mm512_cvtps_pd(_mm512_castps512_ps256(axis));
    }
}
ACDF_LANE void gather_transposed(const double* base, Integer index, Vector out[4]) {
    alignas(64) long long at[8];
    *(Integer*)at = index * 2;
    __m512d row[4]; // of lanes k and k + 4
    for (int k = 0; k < 4; ++k)
        row[k] = _mm512_insertf64x4(_mm512_castpd256_pd512(_mm256_loadu_pd(base + at[k])),
                                    _mm256_loadu_pd(base + at[k + 4]), 1);
    const __m512i even = _mm512_setr_epi64(0, 1, 8, 9, 4, 5, 12, 13),
                  odd = _mm512_setr_epi64(2, 3, 10, 11, 6, 7, 14, 15);
    const __m512d low[2] = {_mm512_unpacklo_pd(row[0], row[1]), _mm512_unpacklo_pd(row[2], row[3])};
    const __m512d high[2] = {_mm512_unpackhi_pd(row[0], row[1]), _mm512_unpackhi_pd(row[2], row[3])};
    out[0] = (Vector)_mm512_permutex2var_pd(low[0], even, low[1]);
    out[1] = (Vector)_mm512_permutex2var_pd(high[0], even, high[1]);
    out[2] = (Vector)_mm512_permutex2var_pd(low[0], odd, low[1]);
    out[3] = (Vector)_mm512_permutex2var_pd(high[0], odd, high[1]);
}
ACDF_LANE Vector every_second(const double* v) {
    return (Vector)_mm512_setr_pd(v[0], v[2], v[4], v[6], v[8], v[10], v[12], v[14]);
}
ACDF_LANE void store(float* out, Vector x) { _mm256_storeu_ps(out, _mm512_cvtpd_ps((__m512d)x)); }
ACDF_LANE void store(AcdfDirectionSample* out, Vector x, Vector y, Vector z, Vector w) {
    const __m256 a = _mm512_cvtpd_ps((__m512d)x), b = _mm512_cvtpd_ps((__m512d)y);
    const __m256 c = _mm512_cvtpd_ps((__m512d)z), d = _mm512_cvtpd_ps((__m512d)w);
    const __m256 ab[2] = {_mm256_unpacklo_ps(a, b), _mm256_unpackhi_ps(a, b)}; // lanes 0 1 4 5 and 2 3 6 7
    const __m256 cd[2] = {_mm256_unpacklo_ps(c, d), _mm256_unpackhi_ps(c, d)};
    for (int i = 0; i < 2; ++i) {
        const __m256 even = _mm256_shuffle_ps(ab[i], cd[i], 0x44), odd = _mm256_shuffle_ps(ab[i], cd[i], 0xEE);
        _mm_storeu_ps((float*)&out[2 * i], _mm256_castps256_ps128(even));
        _mm_storeu_ps((float*)&out[2 * i + 1], _mm256_castps256_ps128(odd));
        _mm_storeu_ps((float*)&out[2 * i + 4], _mm256_extractf128_ps(even, 1));
        _mm_storeu_ps((float*)&out[2 * i + 5], _mm256_extractf128_ps(odd, 1));
    }
}
#else
ACDF_LANE Vector root(Vector x) { return (Vector)_mm256_sqrt_pd((__m256d)x); }
ACDF_LANE Vector rounded_to_float(Vector x) { return (Vector)_mm256_cvtps_pd(_mm256_cvtpd_ps((__m256d)x)); }
ACDF_LANE Integer truncated(Vector x) { return (Integer)_mm256_cvtepi32_epi64(_mm256_cvttpd_epi32((__m256d)x)); }
// Of integers in [0, 2^52).
ACDF_LANE Vector converted(Integer i) { return (Vector)(i | 0x4330000000000000) - 0x1p52; }
ACDF_LANE unsigned bits(Integer mask) { return (unsigned)_mm256_movemask_pd((__m256d)mask); }
ACDF_LANE void load_transposed(const float (*v)[3], Vector out[3]) {
    const float* floats = (const float*)v; // x y z x, y z x y, z x y z
    const __m128 a = _mm_loadu_ps(floats), b = _mm_loadu_ps(floats + 4), c = _mm_loadu_ps(floats + 8);
    const __m128 xy = _mm_shuffle_ps(b, c, _MM_SHUFFLE(2, 1, 3, 2)),
                 yz = _mm_shuffle_ps(a, b, _MM_SHUFFLE(1, 0, 2, 1));
    out[0] = (Vector)_mm256_cvtps_pd(_mm_shuffle_ps(a, xy, _MM_SHUFFLE(2, 0, 3, 0)));
    out[1] = (Vector)_mm256_cvtps_pd(_mm_shuffle_ps(yz, xy, _MM_SHUFFLE(3, 1, 2, 0)));
    out[2] = (Vector)_mm256_cvtps_pd(_mm_shuffle_ps(yz, c, _MM_SHUFFLE(3, 0, 3, 1)));
}
ACDF_LANE void gather_transposed(const double* base, Integer index, Vector out[4]) {
    alignas(32) long long at[4];
    *(Integer*)at = index * 2;
    const __m256d row[4] = {_mm256_loadu_pd(base + at[0]), _mm256_loadu_pd(base + at[1]),
                            _mm256_loadu_pd(base + at[2]), _mm256_loadu_pd(base + at[3])};
    const __m256d low[2] = {_mm256_unpacklo_pd(row[0], row[1]), _mm256_unpacklo_pd(row[2], row[3])};
    const __m256d high[2] = {_mm256_unpackhi_pd(row[0], row[1]), _mm256_unpackhi_pd(row[2], row[3])};
    out[0] = (Vector)_mm256_permute2f128_pd(low[0], low[1], 0x20);
    out[1] = (Vector)_mm256_permute2f128_pd(high[0], high[1], 0x20);
    out[2] = (Vector)_mm256_permute2f128_pd(low[0], low[1], 0x31);
    out[3] = (Vector)_mm256_permute2f128_pd(high[0], high[1], 0x31);
}
ACDF_LANE Vector every_second(const double* v) { return (Vector)_mm256_setr_pd(v[0], v[2], v[4], v[6]); }
ACDF_LANE void store(float* out, Vector x) { _mm_storeu_ps(out, _mm256_cvtpd_ps((__m256d)x)); }
ACDF_LANE void store(AcdfDirectionSample* out, Vector x, Vector y, Vector z, Vector w) {
    __m128 a = _mm256_cvtpd_ps((__m256d)x), b = _mm256_cvtpd_ps((__m256d)y);
    __m128 c = _mm256_cvtpd_ps((__m256d)z), d = _mm256_cvtpd_ps((__m256d)w);
    _MM_TRANSPOSE4_PS(a, b, c, d);
    _mm_storeu_ps((float*)&out[0], a);
    _mm_storeu_ps((float*)&out[1], b);
    _mm_storeu_ps((float*)&out[2], c);
    _mm_storeu_ps((float*)&out[3], d);
}
ACDF_LANE Integer least(Integer a, Integer b) { return a < b ? a : b; }
ACDF_LANE Integer most(Integer a, Integer b) { return a > b ? a : b; }
#endif

ACDF_LANE Integer widened(const int* numbers) {
    typedef int Numbers __attribute__((vector_size(4 * ACDF_WIDTH)));
    Numbers all;
    __builtin_memcpy(&all, numbers, sizeof all);
    return __builtin_convertvector(all, Integer);
}

/* Of numbers in [0, 2^32). */
ACDF_LANE Integer multiplied(Integer a, long long b) {
#if ACDF_WIDTH == 8
    return (Integer)_mm512_mul_epu32((__m512i)a, _mm512_set1_epi64(b));
#else
    return (Integer)_mm256_mul_epu32((__m256i)a, _mm256_set1_epi64x(b));
#endif
}
ACDF_LANE bool any(Integer mask) { return bits(mask) != 0; }
ACDF_LANE Vector select(Integer mask, Vector yes, Vector no) { return mask ? yes : no; }
ACDF_LANE Integer select(Integer mask, Integer yes, Integer no) { return mask ? yes : no; }
ACDF_LANE Vector all(double x) { return Vector{} + x; }
ACDF_LANE Vector absolute(Vector x) { return (Vector)((Integer)x & 0x7FFFFFFFFFFFFFFF); }
/* acdf_unit_interval, acdf_positive. */
ACDF_LANE Vector unit_interval(Vector u) {
    return select((u > 0.0) & (u <= 0x1.fffffffffffffp1023), select(u < 1.0, u, all(1.0)), all(0.0));
}
ACDF_LANE Vector positive(Vector p) { return select(p > 0x1p-1000, p, all(0x1p-1000)); }
/* x, or 0. */
ACDF_LANE Vector only(Integer mask, double x) { return (Vector)(mask & (Integer)all(x)); }
ACDF_LANE Vector one_if(Integer mask) { return only(mask, 1.0); }

} // namespace
