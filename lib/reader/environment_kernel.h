// The loops of EnvironmentWavefront over vectors of ACDF_WIDTH doubles or twice as many floats, by the extensions
// of GCC and Clang. Included by one source a set of instructions, compiled for it; nothing here may be inline with
// external linkage, lest the linker picks code that the processor does not have.
//
// Each function is that of the same name in acdf/pieces.h and acdf/cells.h, a lane an element, operation by
// operation: results agree bit for bit. What searches is done lane by lane, and the loads of all lanes at a time:
// they do not wait for each other. Lanes that tables do not answer are left to the functions of acdf/sample.h.
#pragma once

#include "environment_wavefront.h"

#include <immintrin.h>

#include <algorithm>
#include <cstdint>
#include <cstring>

namespace {

constexpr std::size_t kLanes = 2 * ACDF_WIDTH, kBlock = 32;

typedef float Floats __attribute__((vector_size(8 * ACDF_WIDTH)));
typedef std::int32_t Signed __attribute__((vector_size(8 * ACDF_WIDTH))); // also masks: all ones or 0
typedef std::uint32_t Words __attribute__((vector_size(8 * ACDF_WIDTH)));

#define ACDF_LANE static inline __attribute__((always_inline))

ACDF_LANE Floats root(Floats x) {
#if ACDF_WIDTH == 8
    return (Floats)_mm512_sqrt_ps((__m512)x);
#else
    return (Floats)_mm256_sqrt_ps((__m256)x);
#endif
}
ACDF_LANE Floats select(Signed mask, Floats yes, Floats no) {
    return (Floats)(((Signed)yes & mask) | ((Signed)no & ~mask));
}
ACDF_LANE Floats absolute(Floats x) { return (Floats)((Words)x & 0x7FFFFFFFu); }

/// The grids and cells of one kind of key.
struct Search {
    const std::uint32_t *tables, *grid, *boxes;
    const std::uint16_t* cells;
    std::uint32_t at, shift0, shift1, bits0;
};

ACDF_LANE Search search_of(const AcdfCells* cells, const AcdfSquares& squares) {
    const auto* const tables = (const std::uint32_t*)(const void*)cells;
    return {tables,
            tables + squares.grid,
            tables + squares.boxes,
            (const std::uint16_t*)(const void*)(tables + squares.cells),
            (std::uint32_t)((const std::uint32_t*)(const void*)&squares - tables),
            squares.shift0,
            squares.shift1,
            squares.bits0};
}

/// Of the lanes of a block: keys, and the cells that may hold them.
struct Sought {
    std::uint32_t key[2][kBlock], entry[kBlock], mask[kBlock];
};

/* acdf_squares_find, of all lanes. */
ACDF_LANE void find(const Search& s, Sought* sought) {
    for (std::size_t i = 0; i < kBlock; ++i)
        sought->entry[i] = s.grid[((sought->key[1][i] >> s.shift1) << s.bits0) + (sought->key[0][i] >> s.shift0)];
    for (std::size_t i = 0; i < kBlock; ++i)
        if (sought->entry[i] & ACDF_SQUARES_FINER)
            sought->entry[i] = acdf_squares_entry(s.tables, s.at, sought->key[0][i], sought->key[1][i]);
    for (std::size_t i = 0; i < kBlock; ++i) {
        const std::uint32_t entry = sought->entry[i], block = entry & ACDF_SQUARES_BLOCK_MASK;
        __builtin_prefetch(s.cells + 16 * std::size_t{block});
        sought->mask[i] =
            acdf_squares_candidates(s.boxes + 16 * std::size_t{block}, sought->key[0][i] >> (entry >> 26) & 0xFFu,
                                    sought->key[1][i] >> (entry >> 21 & 31u) & 0xFFu);
    }
}

ACDF_LANE std::uint32_t first_cell(const Search& s, const Sought& sought, std::size_t i, std::uint32_t mask) {
    return s.cells[16 * std::size_t{sought.entry[i] & ACDF_SQUARES_BLOCK_MASK} + acdf_lowest_bit(mask)];
}

// ---- drawing ---------------------------------------------------------------------------------------------------

struct Drawn {
    alignas(64) float azimuth[kBlock], cap[kBlock], pdf[kBlock];
    alignas(64) std::uint32_t quarter[kBlock], south[kBlock]; // in their lowest bits
};

ACDF_LANE void piece_directions(const Drawn& drawn, std::size_t first, Floats out[3]) {
    const Floats y = *(const Floats*)&drawn.azimuth[first], cap = *(const Floats*)&drawn.cap[first];
    const Words quarter = *(const Words*)&drawn.quarter[first] & 3u;
    const Words south = *(const Words*)&drawn.south[first];
    const Floats q = y * y, radius = root(cap * (2.0f - cap));
    const Floats sine = y + y * q * (-0.16666651f + q * (0.0083320351f + q * -0.00019503819f));
    const Floats cosine = 1.0f + q * (-0.5f + q * (0.041666616f + q * (-0.0013886617f + q * 2.4379725e-5f)));
    const Words major = (Words)(radius * cosine), minor = (Words)(radius * sine);
    const Words swapped = (major ^ minor) & (0u - (quarter & 1u));
    out[0] = (Floats)((major ^ swapped) ^ (((quarter + 1u) & 2u) << 30));
    out[1] = (Floats)((minor ^ swapped) ^ ((quarter & 2u) << 30));
    out[2] = (Floats)((Words)(1.0f - cap) ^ (south << 31));
}

/* Lanes that are not to be searched for. */
ACDF_LANE void drop(std::uint32_t lanes, Sought* sought) {
    for (; lanes; lanes &= lanes - 1) sought->mask[acdf_lowest_bit(lanes)] = 0;
}

/* Finds the pieces that numbers lead to, in steps of 2^-52, and where in them. Returns the lanes without one. */
ACDF_LANE std::uint32_t draw_pieces(const AcdfCells* cells, const Search& s, const Sought& sought,
                                    const std::uint64_t (*n)[2], Drawn* drawn) {
    const auto* const pieces = (const AcdfPiece*)(const void*)(s.tables + cells->pieces);
    const auto* const densities = (const float*)(const void*)(s.tables + cells->densities);
    std::uint32_t lost = 0;
    for (std::size_t i = 0; i < kBlock; ++i) {
        std::uint32_t mask = sought.mask[i];
        for (; mask; mask &= mask - 1) {
            const std::uint32_t cell = first_cell(s, sought, i, mask);
            const AcdfPiece& piece = pieces[cell];
            const float d0 = acdf_draw_distance(n[i][0], piece.azimuth.low);
            const float d1 = acdf_draw_distance(n[i][1], piece.height.low);
            const std::uint32_t width0 = acdf_float_bits(piece.azimuth.width),
                                width1 = acdf_float_bits(piece.height.width);
            if (!(acdf_float_bits(d0) < width0 && (acdf_float_bits(d1) ^ width1 << 31) < width1)) continue;
            drawn->azimuth[i] = piece.azimuth.origin + d0 * piece.azimuth.slope;
            drawn->cap[i] = piece.height.origin + d1 * piece.height.slope;
            drawn->pdf[i] = densities[cell];
            drawn->quarter[i] = width0;
            drawn->south[i] = width1;
            break;
        }
        if (__builtin_expect(mask != 0, 1)) continue;
        drawn->azimuth[i] = drawn->cap[i] = drawn->pdf[i] = 0.0f;
        drawn->quarter[i] = drawn->south[i] = 0;
        lost |= 1u << i;
    }
    return lost;
}

ACDF_LANE void store(const Floats direction[3], const float* pdf, AcdfDirectionSample* out) {
    alignas(64) float to[3][kLanes];
    for (int k = 0; k < 3; ++k) *(Floats*)to[k] = direction[k];
    for (std::size_t i = 0; i < kLanes; i += 4) {
        __m128 a = _mm_load_ps(&to[0][i]), b = _mm_load_ps(&to[1][i]), c = _mm_load_ps(&to[2][i]);
        __m128 d = _mm_load_ps(&pdf[i]);
        _MM_TRANSPOSE4_PS(a, b, c, d);
        _mm_storeu_ps((float*)&out[i], a);
        _mm_storeu_ps((float*)&out[i + 1], b);
        _mm_storeu_ps((float*)&out[i + 2], c);
        _mm_storeu_ps((float*)&out[i + 3], d);
    }
}

/* acdf_cells_sample of a block, or the walk. */
ACDF_LANE void sample_block(const AcdfEnvironment& env, const Search& s, const double (*u)[2],
                            AcdfDirectionSample* out) {
    alignas(16) std::uint64_t n[kBlock][2];
    Sought sought;
    Drawn drawn;
    std::uint32_t lost = 0;
    __m128i high = _mm_setzero_si128();
    for (std::size_t i = 0; i < kBlock; ++i) {
        const __m128d shifted = _mm_add_pd(_mm_loadu_pd(u[i]), _mm_set1_pd(1.0));
        const __m128i number = _mm_xor_si128(_mm_castpd_si128(shifted), _mm_set1_epi64x(0x3FF0000000000000));
        const __m128i key = _mm_and_si128(_mm_srli_epi64(number, 21), _mm_set1_epi64x(0x7FFFFFFF));
        _mm_store_si128((__m128i*)n[i], number);
        high = _mm_or_si128(high, number);
        sought.key[0][i] = (std::uint32_t)_mm_cvtsi128_si32(key);
        sought.key[1][i] = (std::uint32_t)_mm_extract_epi32(key, 2);
    }
    find(s, &sought);
    if (!_mm_testz_si128(high, _mm_set1_epi64x((long long)0xFFF0000000000000u))) { // numbers outside of [0, 1)
        for (std::size_t i = 0; i < kBlock; ++i) lost |= (std::uint32_t)((n[i][0] | n[i][1]) >> 52 != 0) << i;
        drop(lost, &sought);
    }
    lost = draw_pieces(env.cells, s, sought, n, &drawn);
    for (std::size_t first = 0; first < kBlock; first += kLanes) {
        Floats direction[3];
        piece_directions(drawn, first, direction);
        store(direction, &drawn.pdf[first], out + first);
    }
    for (; lost; lost &= lost - 1) {
        const std::uint32_t i = acdf_lowest_bit(lost);
        out[i] = acdf_environment_sample(&env, u[i][0], u[i][1]);
    }
}

// ---- finding ---------------------------------------------------------------------------------------------------

struct Places {
    alignas(64) float azimuth[kBlock], cap[kBlock];
};

/* acdf_direction_place and acdf_atan_float. Returns the lanes of which floats do not tell. */
ACDF_LANE std::uint32_t place(const float (*w)[3], std::size_t first, Places* places, Sought* sought) {
    Floats x, y, z;
    for (std::size_t i = 0; i < kLanes; ++i) x[i] = w[first + i][0], y[i] = w[first + i][1], z[i] = w[first + i][2];
    const Floats sin2 = x * x + y * y, length2 = sin2 + z * z;
    const Signed refused = ((Words)length2 - 0x3F7FF972u > 0x000009D4u) | ((Words)sin2 < 0x2B800000u);
    const Signed steep = absolute(y) > absolute(x);
    const Floats minor = select(steep, -x, y), major = select(steep, y, x);
    Floats cap = sin2 * (2.0f - length2) / (1.0f + absolute(z) * (1.5f - 0.5f * length2));
    const Floats slope = minor / major;
    cap = select(cap < 1.0f, cap, Floats{} + 1.0f);
    const Floats step0 = select(refused, Floats{}, slope * ACDF_SLOPE_STEPS + ACDF_SLOPE_STEPS);
    const Floats step1 = select(refused, Floats{}, cap * ACDF_CAP_STEPS);
    const Words quarter = ((Words)steep & 1u) | (((Words)major >> 30) & 2u);
    const Words key0 = ((quarter << 23) + (Words) __builtin_convertvector(step0, Signed)) & ACDF_DIRECTION_MASK;
    const Words key1 =
        ((Words) __builtin_convertvector(step1, Signed) ^ (0u - ((Words)z >> 31))) & ACDF_DIRECTION_MASK;
    const Floats q = slope * slope, q2 = q * q;
    const Floats low = (0.99999988f + q * -0.33331813f) + q2 * (0.19966962f + q * -0.14003290f);
    const Floats high = (0.098688655f + q * -0.058829753f) + q2 * (0.023780519f + q * -0.0045597920f);
    *(Floats*)&places->azimuth[first] = slope * (low + q2 * q2 * high);
    *(Floats*)&places->cap[first] = cap;
    std::memcpy(&sought->key[0][first], &key0, sizeof key0);
    std::memcpy(&sought->key[1][first], &key1, sizeof key1);
#if ACDF_WIDTH == 8
    return (std::uint32_t)_mm512_movepi32_mask((__m512i)refused) << first;
#else
    return (std::uint32_t)_mm256_movemask_ps((__m256)refused) << first;
#endif
}

/* acdf_cells_pdf of a block, or the walk. */
ACDF_LANE void pdf_block(const AcdfEnvironment& env, const Search& s, const float (*w)[3], float* out) {
    const auto* const pieces = (const AcdfPiece*)(const void*)(s.tables + env.cells->pieces);
    const auto* const densities = (const float*)(const void*)(s.tables + env.cells->densities);
    Sought sought;
    Places places;
    std::uint32_t lost = 0;
    for (std::size_t first = 0; first < kBlock; first += kLanes) lost |= place(w, first, &places, &sought);
    find(s, &sought);
    drop(lost, &sought);
    for (std::size_t i = 0; i < kBlock; ++i) {
        std::uint32_t mask = sought.mask[i];
        for (; mask; mask &= mask - 1) {
            const std::uint32_t cell = first_cell(s, sought, i, mask);
            const AcdfPiece& piece = pieces[cell];
            const float d0 = piece.azimuth.origin - places.azimuth[i], d1 = places.cap[i] - piece.height.origin;
            const float width0 = -(piece.azimuth.width * piece.azimuth.slope);
            const float width1 = fabsf(piece.height.width * piece.height.slope);
            if (!(acdf_float_bits(d0) < acdf_float_bits(width0) && acdf_float_bits(d1) < acdf_float_bits(width1)))
                continue;
            out[i] = densities[cell];
            break;
        }
        if (__builtin_expect(mask == 0, 0)) out[i] = acdf_environment_pdf(&env, w[i]);
    }
}

// ---- all of an array -------------------------------------------------------------------------------------------

/* What does not fill a block is copied to the front of one. */
template <class In, class Out, class Block>
ACDF_LANE void for_blocks(const In* in, std::size_t count, Out* out, const Block& block) {
    std::size_t first = 0;
    for (; first + kBlock <= count; first += kBlock) block(in + first, out + first);
    if (first == count) return;
    In last[kBlock] = {};
    Out result[kBlock];
    std::memcpy(last, in + first, (count - first) * sizeof(In));
    block(last, result);
    std::memcpy(out + first, result, (count - first) * sizeof(Out));
}

ACDF_LANE void sample_all(const AcdfEnvironment& env, const double (*u)[2], std::size_t count,
                          AcdfDirectionSample* out) {
    const Search s = search_of(env.cells, env.cells->numbers);
    for_blocks(u, count, out,
               [&](const double(*from)[2], AcdfDirectionSample* to) { sample_block(env, s, from, to); });
}
ACDF_LANE void pdf_all(const AcdfEnvironment& env, const float (*w)[3], std::size_t count, float* out) {
    const Search s = search_of(env.cells, env.cells->directions);
    for_blocks(w, count, out, [&](const float(*from)[3], float* to) { pdf_block(env, s, from, to); });
}

} // namespace
