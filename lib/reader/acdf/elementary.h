/* What the headers of the reader share: the qualifier of their functions, numbers that are neither NaN nor
 * infinite, and elementary functions.
 *
 * These are written out so that every machine samples the same directions and finds the same cells, which its libm
 * would not grant, and because two atan2 calls would cost more than the rest. */
#ifndef ACDF_ELEMENTARY_H
#define ACDF_ELEMENTARY_H

#include <math.h>
#include <stdint.h>
#include <string.h>

/* This compilation is for a GPU, not for the host around it. */
#if defined(__CUDA_ARCH__) || defined(__HIP_DEVICE_COMPILE__) || defined(__SYCL_DEVICE_ONLY__)
#define ACDF_ON_GPU 1
#endif

#ifndef ACDF_FN
#if defined(__CUDACC__) || defined(__HIPCC__)
#define ACDF_FN static inline __host__ __device__
#else
#define ACDF_FN static inline
#endif
#endif
#if defined(__GNUC__)
#define ACDF_UNUSED __attribute__((unused))
#else
#define ACDF_UNUSED
#endif
/* Functions that are faster as a part of what calls them, and what is rarely called from such. Of the latter, those
 * of _ON_CPU are taken in by kernels, too: what gets the address of a variable keeps it out of registers.
 * ACDF_CALLED is what kernels call, but processors need not: it would take minutes to compile. */
#ifndef ACDF_INLINE
#if defined(__CUDACC__) || defined(__HIPCC__)
#define ACDF_INLINE static __forceinline__ __host__ __device__
#define ACDF_OUTLINE static __noinline__ ACDF_UNUSED __host__ __device__
#define ACDF_OUTLINE_ON_CPU ACDF_FN
#define ACDF_CALLED ACDF_OUTLINE
#else
#if defined(__GNUC__)
#define ACDF_INLINE static inline __attribute__((always_inline))
#ifdef __OPTIMIZE__
#define ACDF_OUTLINE static __attribute__((noinline, unused))
#else /* when not optimising, gcc compiles static functions that nothing calls as well, unless they are inline */
#define ACDF_OUTLINE ACDF_FN
#endif
#else
#define ACDF_INLINE ACDF_FN
#define ACDF_OUTLINE ACDF_FN
#endif
#define ACDF_OUTLINE_ON_CPU ACDF_OUTLINE
#define ACDF_CALLED ACDF_FN
#endif
#endif

/* What is wanted next, on its way while its position is searched for. */
#if defined(__GNUC__) && !defined(__CUDACC__)
#define ACDF_PREFETCH(address) __builtin_prefetch(address)
#else
#define ACDF_PREFETCH(address) (void)(address)
#endif

/* Vectors of two doubles or of four integers, which every x86-64 has. */
#if defined(__SSE2__) && !defined(__CUDACC__) && !defined(__HIPCC__) && !defined(__SYCL_DEVICE_ONLY__)
#define ACDF_SSE2 1
#include <emmintrin.h>
#endif

#ifdef __cplusplus
extern "C" {
#endif

/* Whether numbers are neither NaN nor infinite, by their bits: compilers that assume that there are no such numbers
 * (-ffast-math) leave out the comparisons. */
ACDF_FN int acdf_is_finite(double x) {
    uint64_t bits;
    memcpy(&bits, &x, sizeof bits);
    return (bits >> 52 & 0x7FFu) != 0x7FFu;
}
ACDF_FN int acdf_are_finite(const float v[3]) {
    const uint32_t exponent = 0x7F800000u;
    uint32_t bits[3];
    memcpy(bits, v, sizeof bits);
    return (bits[0] & exponent) != exponent && (bits[1] & exponent) != exponent && (bits[2] & exponent) != exponent;
}

/* Whether the square of a length is in (0.999, 1.001), by its bits, too: it is if a vector is finite and of unit
 * length. */
ACDF_FN int acdf_is_unit_square(double length2) {
    uint64_t bits;
    memcpy(&bits, &length2, sizeof bits);
    return bits - 0x3FEFF7CED916872Cu < 0x3FF004189374BC6Au - 0x3FEFF7CED916872Cu;
}

ACDF_FN double acdf_clamp(double x, double low, double high) { return x < low ? low : x > high ? high : x; }

/* The floats of v. Where a caller rounds doubles to v and is inlined, gcc 12 (x86 without AVX, from -O2 on) takes a
 * pair of them that becomes doubles again for what was rounded. What went through assembly, were it none, or
 * through memory, which takes longer, it takes as it is. */
ACDF_INLINE void acdf_as_given(const float v[3], float out[3]) {
#if defined(__GNUC__) && !defined(__clang__) && !defined(ACDF_ON_GPU) && !defined(ACDF_SSE2)
    volatile float given[3];
#else
    float given[3];
#endif
    int i;
    for (i = 0; i < 3; ++i) given[i] = v[i];
#if defined(__GNUC__) && !defined(__clang__) && defined(ACDF_SSE2)
    for (i = 0; i < 3; ++i) __asm__("" : "+x"(given[i]));
#endif
    for (i = 0; i < 3; ++i) out[i] = given[i];
}

#define ACDF_PI 3.14159265358979323846

/* Polynomials of degree 7 and 3 in q, summed as a tree: short chains of dependent operations. */
ACDF_FN double acdf_polynomial4(double q, double c0, double c1, double c2, double c3) {
    return (c0 + q * c1) + q * q * (c2 + q * c3);
}
ACDF_FN double acdf_polynomial8(double q, double c0, double c1, double c2, double c3, double c4, double c5,
                                double c6, double c7) {
    const double q2 = q * q;
    return acdf_polynomial4(q, c0, c1, c2, c3) + q2 * q2 * acdf_polynomial4(q, c4, c5, c6, c7);
}

/* Taylor series in q = y^2, for |y| <= pi/4, error below 2e-16: of sin(y) / y and of (cos(y) - 1) / q. */
#define ACDF_SINE_SERIES                                                                                           \
    1.0, -1.0 / 6, 1.0 / 120, -1.0 / 5040, 1.0 / 362880, -1.0 / 39916800, 1.0 / 6227020800.0, -1.0 / 1307674368000.0
#define ACDF_COSINE_SERIES                                                                                         \
    -1.0 / 2, 1.0 / 24, -1.0 / 720, 1.0 / 40320, -1.0 / 3628800, 1.0 / 479001600.0, -1.0 / 87178291200.0,          \
        1.0 / 20922789888000.0
ACDF_FN double acdf_sine(double y) { return y * acdf_polynomial8(y * y, ACDF_SINE_SERIES); }
ACDF_FN double acdf_cosine(double y) {
    const double q = y * y;
    return 1.0 + q * acdf_polynomial8(q, ACDF_COSINE_SERIES);
}

#ifdef ACDF_SSE2
/* Two polynomials of degree 3 by their coefficients, as acdf_polynomial4 has one. */
ACDF_INLINE __m128d acdf_two_polynomials4(__m128d q, const double* low, const double* high) {
    const __m128d c01 = _mm_add_pd(_mm_set_pd(high[0], low[0]), _mm_mul_pd(q, _mm_set_pd(high[1], low[1])));
    const __m128d c23 = _mm_add_pd(_mm_set_pd(high[2], low[2]), _mm_mul_pd(q, _mm_set_pd(high[3], low[3])));
    return _mm_add_pd(c01, _mm_mul_pd(_mm_mul_pd(q, q), c23));
}
#endif

/* sin(pi x) and cos(pi x) for x in [-2, 2]. Swapped and negated by their bits: nobody can guess which quadrant
 * comes next. */
ACDF_FN void acdf_sincospi(double x, double* sine, double* cosine) {
#ifdef ACDF_SSE2
    const double series[2][8] = {{ACDF_SINE_SERIES}, {ACDF_COSINE_SERIES}};
    /* The nearest multiple of 1/2, twice; zeros stand above. */
    const __m128i turned = _mm_cvttpd_epi32(_mm_set1_pd(2.0 * x + 4.5));
    const __m128i quadrant = _mm_sub_epi32(turned, _mm_set1_epi32(4));
    const __m128d nearest = _mm_mul_pd(_mm_set1_pd(0.5), _mm_cvtepi32_pd(quadrant));
    const __m128d y = _mm_mul_pd(_mm_sub_pd(_mm_set1_pd(x), nearest), _mm_set1_pd(ACDF_PI));
    const __m128d q = _mm_mul_pd(y, y), q2 = _mm_mul_pd(q, q);
    const __m128d polynomial =
        _mm_add_pd(acdf_two_polynomials4(q, series[0], series[1]),
                   _mm_mul_pd(_mm_mul_pd(q2, q2), acdf_two_polynomials4(q, series[0] + 4, series[1] + 4)));
    const __m128d either = _mm_add_pd(_mm_set_pd(1.0, -0.0), _mm_mul_pd(_mm_move_sd(q, y), polynomial));
    const __m128i both = _mm_unpacklo_epi32(quadrant, quadrant), next = _mm_set_epi32(1, 1, 0, 0);
    const __m128d odd = _mm_castsi128_pd(_mm_srai_epi32(_mm_slli_epi32(both, 31), 31));
    const __m128d sign = _mm_castsi128_pd(_mm_slli_epi32(_mm_add_epi32(both, next), 30));
    const __m128d swapped = _mm_and_pd(_mm_xor_pd(either, _mm_shuffle_pd(either, either, 1)), odd);
    const __m128d out = _mm_xor_pd(either, _mm_xor_pd(swapped, _mm_and_pd(sign, _mm_set1_pd(-0.0))));
    *sine = _mm_cvtsd_f64(out);
    *cosine = _mm_cvtsd_f64(_mm_unpackhi_pd(out, out));
#else
    const int quadrant = (int)(2.0 * x + 4.5) - 4; /* the nearest multiple of 1/2 */
    const double y = (x - 0.5 * quadrant) * ACDF_PI;
    const double either[2] = {acdf_sine(y), acdf_cosine(y)};
    uint64_t bits[2], swapped;
    memcpy(bits, either, sizeof bits);
    swapped = (bits[0] ^ bits[1]) & (0u - (uint64_t)(quadrant & 1));
    bits[0] ^= swapped ^ (uint64_t)(quadrant & 2) << 62;
    bits[1] ^= swapped ^ (uint64_t)((quadrant + 1) & 2) << 62;
    memcpy(sine, &bits[0], sizeof *sine);
    memcpy(cosine, &bits[1], sizeof *cosine);
#endif
}

/* 1 or -1, with the sign of x. */
ACDF_FN double acdf_sign(double x) { return copysign(1.0, x); }

/* x where a < b, else 0, of finite numbers: what is chosen by a condition, compilers turn into branches. */
ACDF_INLINE double acdf_if_less(double a, double b, double x) {
#ifdef ACDF_SSE2
    return _mm_cvtsd_f64(_mm_and_pd(_mm_cmplt_sd(_mm_set_sd(a), _mm_set_sd(b)), _mm_set_sd(x)));
#else
    return (0.5 - 0.5 * acdf_sign(a - b + 0.0)) * x; /* -0 is not below 0 */
#endif
}

/* atan(w) / pi for |w| <= tan(pi/8). The series in q = w^2 of atan(w) / (pi w) was interpolated at the Chebyshev
 * nodes of [0, tan(pi/8)^2]. */
ACDF_INLINE double acdf_narrow_atanpi(double w) {
    const double q = w * w, q4 = (q * q) * (q * q);
    const double series =
        acdf_polynomial8(q, 0.31830988618379064, -0.10610329539458131, 0.063661977233113842, -0.045472840550007838,
                         0.035367749436769451, -0.028936829427649351, 0.024477882221680791, -0.0211365210662873) +
        q4 * q4 * (0.018106577949592299 + q * (-0.01384028005905886 + q * 0.0067275982242772812));
    return w * series;
}

/* atan2(y, x) / pi of finite numbers, error below 2e-16; 0 for y = x = 0. */
ACDF_FN double acdf_atan2pi(double y, double x) {
    const double ax = fabs(x), ay = fabs(y);
    const double high = ax > ay ? ax : ay, low = ax < ay ? ax : ay;
    /* Signs are multiplied by: no processor guesses in which octant a direction lies. */
    const double narrow = acdf_sign(0.41421356237309503 * high - low); /* -1 beyond tan(pi/8): from pi/4 */
    const double level = acdf_sign(ax - ay), east = acdf_sign(x + 0.0), wide = 0.5 - 0.5 * narrow;
    const double w = high > 0.0 ? (low - wide * high) / (high + wide * low) : 0.0;
    double turn = acdf_narrow_atanpi(w) + 0.25 * wide;
    turn = (0.25 - 0.25 * level) + level * turn;
    turn = (0.5 - 0.5 * east) + east * turn;
    return acdf_sign(y + 0.0) * turn;
}

#ifdef __cplusplus
}
#endif
#endif
