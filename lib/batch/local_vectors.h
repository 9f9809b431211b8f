// What the loops of LocalBatch and those of groups of cells need beside the vectors of the other two: pairs of
// doubles that are gathered, lanes that are packed, and what acdf/elementary.h says of single numbers. Internal
// linkage: see local_kernel.h.
#pragma once

#include "batch/batch_vectors.h"
#include "batch/piece_vectors.h"

namespace {

// ---- masks -----------------------------------------------------------------------------------------------------

#if ACDF_WIDTH == 8
typedef __mmask8 Mask;
ACDF_LANE Mask less(Vector a, Vector b) { return _mm512_cmp_pd_mask((__m512d)a, (__m512d)b, _CMP_LT_OQ); }
/* Whether any of some bits is set. */
ACDF_LANE Mask has(Integer x, long long some) {
    return _mm512_test_epi64_mask((__m512i)x, _mm512_set1_epi64(some));
}
ACDF_LANE Mask negative(Integer x) { return _mm512_movepi64_mask((__m512i)x); }
ACDF_LANE Integer widened(Signed x, int half) {
    return (Integer)_mm512_cvtepi32_epi64(half ? _mm512_extracti64x4_epi64((__m512i)x, 1)
                                               : _mm512_castsi512_si256((__m512i)x));
}
ACDF_LANE Mask both(Mask a, Mask b) { return _kand_mask8(a, b); }
ACDF_LANE Mask either(Mask a, Mask b) { return _kor_mask8(a, b); }
ACDF_LANE Mask without(Mask a, Mask b) { return _kandn_mask8(b, a); } /* a and not b */
ACDF_LANE Mask all_lanes() { return 0xFF; }
ACDF_LANE Mask no_lanes() { return 0; }
ACDF_LANE unsigned lanes(Mask mask) { return mask; }
ACDF_LANE Vector choose(Mask mask, Vector yes, Vector no) {
    return (Vector)_mm512_mask_blend_pd(mask, (__m512d)no, (__m512d)yes);
}
ACDF_LANE Integer choose(Mask mask, Integer yes, Integer no) {
    return (Integer)_mm512_mask_blend_epi64(mask, (__m512i)no, (__m512i)yes);
}
#else
typedef __m256d Mask;
ACDF_LANE Mask all_lanes() { return (Mask)_mm256_set1_epi64x(-1); }
ACDF_LANE Mask no_lanes() { return _mm256_setzero_pd(); }
ACDF_LANE Mask less(Vector a, Vector b) { return _mm256_cmp_pd((__m256d)a, (__m256d)b, _CMP_LT_OQ); }
ACDF_LANE Mask equal(Integer a, Integer b) { return (Mask)_mm256_cmpeq_epi64((__m256i)a, (__m256i)b); }
ACDF_LANE Mask without(Mask a, Mask b) { return _mm256_andnot_pd(b, a); }
ACDF_LANE Mask has(Integer x, long long some) { return without(all_lanes(), equal(x & some, Integer{})); }
ACDF_LANE Mask negative(Integer x) { return (Mask)x; } /* by their highest bits */
ACDF_LANE Integer widened(Signed x, int half) {
    return (Integer)_mm256_cvtepi32_epi64(half ? _mm256_extracti128_si256((__m256i)x, 1)
                                               : _mm256_castsi256_si128((__m256i)x));
}
ACDF_LANE Mask both(Mask a, Mask b) { return _mm256_and_pd(a, b); }
ACDF_LANE Mask either(Mask a, Mask b) { return _mm256_or_pd(a, b); }
ACDF_LANE unsigned lanes(Mask mask) { return (unsigned)_mm256_movemask_pd(mask); }
ACDF_LANE Vector choose(Mask mask, Vector yes, Vector no) {
    return (Vector)_mm256_blendv_pd((__m256d)no, (__m256d)yes, mask);
}
ACDF_LANE Integer choose(Mask mask, Integer yes, Integer no) {
    return (Integer)choose(mask, (Vector)yes, (Vector)no);
}
#endif

// ---- memory ----------------------------------------------------------------------------------------------------

ACDF_LANE Vector loaded(const double* from) {
    Vector x;
    __builtin_memcpy(&x, from, sizeof x);
    return x;
}
ACDF_LANE Integer loaded(const long long* from) {
    Integer x;
    __builtin_memcpy(&x, from, sizeof x);
    return x;
}
ACDF_LANE void stored(double* to, Vector x) { __builtin_memcpy(to, &x, sizeof x); }
ACDF_LANE void stored(long long* to, Integer x) { __builtin_memcpy(to, &x, sizeof x); }

/* Eight bytes at each address: by what takes least on processors of 2023, which for four lanes is not to gather. */
ACDF_LANE Integer loaded_at(Integer address) {
#if ACDF_WIDTH == 8
    return (Integer)_mm512_i64gather_epi64((__m512i)address, nullptr, 1);
#else
    const __m128i half[2] = {_mm256_castsi256_si128((__m256i)address),
                             _mm256_extracti128_si256((__m256i)address, 1)};
    __m128d pair[2];
    for (int i = 0; i < 2; ++i) {
        pair[i] = _mm_load_sd((const double*)_mm_cvtsi128_si64(half[i]));
        pair[i] = _mm_loadh_pd(pair[i], (const double*)_mm_extract_epi64(half[i], 1));
    }
    return (Integer)_mm256_set_m128d(pair[1], pair[0]);
#endif
}
/* Elements of an array. */
template <class T>
ACDF_LANE Integer loaded_from(const T* array, Integer index) {
    static_assert(sizeof(T) == 8, "of eight bytes each");
    return loaded_at(index * 8 + (long long)(std::uintptr_t)array);
}

/* Addresses one by one: of eight lanes it takes least to store them. */
template <class T>
ACDF_LANE void pointers_of(Integer address, const T* out[ACDF_WIDTH]) {
#if ACDF_WIDTH == 8
    alignas(64) long long at[ACDF_WIDTH];
    stored(at, address);
    for (int i = 0; i < ACDF_WIDTH; ++i) out[i] = (const T*)at[i];
#else
    const __m128i half[2] = {_mm256_castsi256_si128((__m256i)address),
                             _mm256_extracti128_si256((__m256i)address, 1)};
    for (int i = 0; i < 2; ++i) {
        out[2 * i] = (const T*)_mm_cvtsi128_si64(half[i]);
        out[2 * i + 1] = (const T*)_mm_extract_epi64(half[i], 1);
    }
#endif
}
/* Two bytes of each lane next to each other: at(i) of lane i. */
template <class At>
ACDF_LANE __m128i two_bytes(const At& at) {
    __m128i value = _mm_setzero_si128(); /* not by memory: a vector would wait for what is stored in parts */
#define ACDF_INSERT(i) value = _mm_insert_epi16(value, (std::int16_t)at(std::size_t{i}), i)
    ACDF_INSERT(0), ACDF_INSERT(1), ACDF_INSERT(2), ACDF_INSERT(3);
#if ACDF_WIDTH == 8
    ACDF_INSERT(4), ACDF_INSERT(5), ACDF_INSERT(6), ACDF_INSERT(7);
#endif
#undef ACDF_INSERT
    return value;
}
ACDF_LANE Integer two_bytes_at(Integer address) {
    const std::uint16_t* from[ACDF_WIDTH];
    pointers_of(address, from);
    const __m128i value = two_bytes([&](std::size_t i) { return *from[i]; });
#if ACDF_WIDTH == 8
    return (Integer)_mm512_cvtepu16_epi64(value);
#else
    return (Integer)_mm256_cvtepu16_epi64(value);
#endif
}

// ---- pairs of doubles, and packed lanes ------------------------------------------------------------------------

#if ACDF_WIDTH == 8
/* The floats in the lower halves. */
ACDF_LANE Vector low_floats(Integer x) {
    return (Vector)_mm512_cvtps_pd(_mm256_castsi256_ps(_mm512_cvtepi64_epi32((__m512i)x)));
}
/* Writes the lanes of a mask one after the other, and anything up to the end of the vector. */
ACDF_LANE void store_packed(double* out, Vector x, unsigned mask) {
    _mm512_storeu_pd(out, _mm512_maskz_compress_pd((__mmask8)mask, (__m512d)x));
}
#else
ACDF_LANE Vector low_floats(Integer x) {
    const __m256i low = _mm256_permutevar8x32_epi32((__m256i)x, _mm256_setr_epi32(0, 2, 4, 6, 0, 0, 0, 0));
    return (Vector)_mm256_cvtps_pd(_mm_castsi128_ps(_mm256_castsi256_si128(low)));
}
/// Of the floats of a vector of doubles, those of the lanes of a mask.
struct Packing {
    alignas(32) std::int32_t order[16][8];
    constexpr Packing() : order() {
        for (int mask = 0; mask < 16; ++mask)
            for (int lane = 0, to = 0; lane < 4; ++lane)
                if (mask >> lane & 1) {
                    order[mask][to++] = 2 * lane;
                    order[mask][to++] = 2 * lane + 1;
                }
    }
};
constexpr Packing kPacking;
ACDF_LANE void store_packed(double* out, Vector x, unsigned mask) {
    const __m256i order = _mm256_load_si256((const __m256i*)(const void*)kPacking.order[mask]);
    _mm256_storeu_ps((float*)out, _mm256_permutevar8x32_ps((__m256)x, order));
}
#endif

ACDF_LANE void store_packed(long long* out, Integer x, unsigned mask) {
    store_packed((double*)(void*)out, (Vector)x, mask);
}

/* The numbers of lanes from one on. */
ACDF_LANE Integer numbers_from(std::size_t first) {
    Integer lane;
    for (int i = 0; i < ACDF_WIDTH; ++i) lane[i] = i;
    return lane + (long long)first;
}

ACDF_LANE Vector above_zero(Vector x) {
#if ACDF_WIDTH == 8
    return (Vector)_mm512_max_pd((__m512d)x, _mm512_setzero_pd());
#else
    return (Vector)_mm256_max_pd((__m256d)x, _mm256_setzero_pd());
#endif
}
ACDF_LANE Vector least(Vector a, Vector b) {
#if ACDF_WIDTH == 8
    return (Vector)_mm512_min_pd((__m512d)a, (__m512d)b);
#else
    return (Vector)_mm256_min_pd((__m256d)a, (__m256d)b);
#endif
}
ACDF_LANE Vector whole_part(Vector x) { // of x in [0, 2^31)
#if ACDF_WIDTH == 8
    return (Vector)_mm512_roundscale_pd((__m512d)x, _MM_FROUND_TO_ZERO | _MM_FROUND_NO_EXC);
#else
    return (Vector)_mm256_round_pd((__m256d)x, _MM_FROUND_TO_ZERO | _MM_FROUND_NO_EXC);
#endif
}

} // namespace
