// The fast shape (acdf/fast_rows.h) over vectors: shading points and what their rows give to tiles a lane an
// element, and searches of a lane's lists, each by one vector of sixteen ends. The same integers, so the same bits.
// Internal linkage: see local_kernel.h.
#pragma once

#include "batch/local_light_vectors.h"

#include <algorithm>
#include <cstddef>
#include <cstring>

namespace {

// ---- numbers of 32 bits ----------------------------------------------------------------------------------------

typedef HalfSigned Ints; // ACDF_WIDTH of them

ACDF_LANE Ints loaded(const std::int32_t* from) {
    Ints x;
    __builtin_memcpy(&x, from, sizeof x);
    return x;
}
ACDF_LANE void stored(std::int32_t* to, Ints x) { __builtin_memcpy(to, &x, sizeof x); }
ACDF_LANE Vector to_doubles(Ints x) { return __builtin_convertvector(x, Vector); }
ACDF_LANE Ints to_integers(Vector x) { return __builtin_convertvector(x, Ints); } // rounded towards 0
ACDF_LANE Integer to_indices(Ints x) { return __builtin_convertvector(x, Integer); }

/* The highest bit of each lane. */
ACDF_LANE unsigned sign_bits(Ints x) {
#if ACDF_WIDTH == 8
    return (unsigned)_mm256_movemask_ps((__m256)x);
#else
    return (unsigned)_mm_movemask_ps((__m128)x);
#endif
}

#if ACDF_WIDTH == 8
ACDF_LANE Ints least(Ints a, Ints b) { return (Ints)_mm256_min_epi32((__m256i)a, (__m256i)b); }
#else
ACDF_LANE Ints least(Ints a, Ints b) { return (Ints)_mm_min_epi32((__m128i)a, (__m128i)b); }
#endif

ACDF_LANE __m128i four_words(const void* at) { return _mm_loadu_si128((const __m128i*)at); }

/* The first four words at each address. */
template <class T>
ACDF_LANE void gather_fours(const T* const* at, Ints out[4]) {
#if ACDF_WIDTH == 8
    __m256i row[4], half[4];
    for (int i = 0; i < 4; ++i) row[i] = _mm256_set_m128i(four_words(at[i + 4]), four_words(at[i]));
    for (int i = 0; i < 2; ++i) {
        half[i] = _mm256_unpacklo_epi32(row[2 * i], row[2 * i + 1]);
        half[2 + i] = _mm256_unpackhi_epi32(row[2 * i], row[2 * i + 1]);
    }
    for (int i = 0; i < 2; ++i) {
        out[2 * i] = (Ints)_mm256_unpacklo_epi64(half[2 * i], half[2 * i + 1]);
        out[2 * i + 1] = (Ints)_mm256_unpackhi_epi64(half[2 * i], half[2 * i + 1]);
    }
#else
    __m128i half[4];
    for (int i = 0; i < 2; ++i) {
        const __m128i even = four_words(at[2 * i]), odd = four_words(at[2 * i + 1]);
        half[i] = _mm_unpacklo_epi32(even, odd);
        half[2 + i] = _mm_unpackhi_epi32(even, odd);
    }
    for (int i = 0; i < 2; ++i) {
        out[2 * i] = (Ints)_mm_unpacklo_epi64(half[2 * i], half[2 * i + 1]);
        out[2 * i + 1] = (Ints)_mm_unpackhi_epi64(half[2 * i], half[2 * i + 1]);
    }
#endif
}

/* Two bytes of each lane: at(i) of lane i. */
template <class At>
ACDF_LANE Ints two_bytes_of(const At& at) {
#if ACDF_WIDTH == 8
    return (Ints)_mm256_cvtepu16_epi32(two_bytes(at));
#else
    return (Ints)_mm_cvtepu16_epi32(two_bytes(at));
#endif
}
/* Elements of an array. */
ACDF_LANE Ints two_bytes_of(const std::uint16_t* base, Ints index) {
    return two_bytes_of([&](std::size_t i) { return base[(std::uint32_t)index[i]]; });
}

/* A word of each lane: at(i) of lane i. */
template <class At>
ACDF_LANE Ints words_of(const At& at) {
    Ints out = {};
    for (std::size_t i = 0; i < ACDF_WIDTH; ++i) out[i] = at(i);
    return out;
}

/* The word at an offset from each. */
template <class T>
ACDF_LANE Ints words_at(const T* const* at, std::size_t offset) {
    return words_of([&](std::size_t i) {
        std::int32_t word;
        std::memcpy(&word, (const char*)at[i] + offset, sizeof word);
        return word;
    });
}

/* acdf_fast_scaled */
ACDF_LANE Vector scaled(Vector u, Vector whole) {
    const Vector x = u * whole, most = whole * (1.0 - 0x1p-53);
    return select(x < most, x, most);
}

/* How many lower bits of masses, below 2^30, weights of 14 bits leave out. */
ACDF_LANE Ints shift_of(Ints mass) {
    /* With the bit below the highest one cleared nothing is rounded up to the next power of two. */
    const Ints exponent = (Ints) __builtin_convertvector(mass & ~(mass >> 1), HalfFloats) >> 23;
    const Ints shift = exponent - (127 + 13);
    return shift & ~(shift >> 31);
}

// ---- searches --------------------------------------------------------------------------------------------------

/// Sixteen mixed ends, and the weights that mix them: of two rows in one word, and of the third.
struct Sixteen {
#if ACDF_WIDTH == 8
    __m512i sum;

    ACDF_LANE_MEMBER void mix(__m256i end0, __m256i end1, __m256i end2, std::int32_t pair, std::int32_t last) {
        const __m512i both =
            _mm512_or_si512(_mm512_cvtepu16_epi32(end0), _mm512_slli_epi32(_mm512_cvtepu16_epi32(end1), 16));
        sum = _mm512_add_epi32(_mm512_madd_epi16(both, _mm512_set1_epi32(pair)),
                               _mm512_madd_epi16(_mm512_cvtepu16_epi32(end2), _mm512_set1_epi32(last)));
    }
    /* Bit i, or more of them: whether number i is above x. */
    ACDF_LANE_MEMBER std::uint32_t above(std::int32_t x) const {
        return _mm512_cmpgt_epi32_mask(sum, _mm512_set1_epi32(x));
    }
    static constexpr std::uint32_t kBits = 1;
    ACDF_LANE_MEMBER void store(std::int32_t* out) const { _mm512_storeu_si512(out, sum); }
#else
    __m256i low, high; // numbers 0 to 3 and 8 to 11, and the others

    ACDF_LANE_MEMBER void mix(__m256i end0, __m256i end1, __m256i end2, std::int32_t pair, std::int32_t last) {
        const __m256i weight01 = _mm256_set1_epi32(pair), weight2 = _mm256_set1_epi32(last);
        const __m256i zero = _mm256_setzero_si256();
        low = _mm256_add_epi32(_mm256_madd_epi16(_mm256_unpacklo_epi16(end0, end1), weight01),
                               _mm256_madd_epi16(_mm256_unpacklo_epi16(end2, zero), weight2));
        high = _mm256_add_epi32(_mm256_madd_epi16(_mm256_unpackhi_epi16(end0, end1), weight01),
                                _mm256_madd_epi16(_mm256_unpackhi_epi16(end2, zero), weight2));
    }
    ACDF_LANE_MEMBER std::uint32_t above(std::int32_t x) const {
        const __m256i at = _mm256_set1_epi32(x);
        return (std::uint32_t)_mm256_movemask_epi8(
            _mm256_packs_epi32(_mm256_cmpgt_epi32(low, at), _mm256_cmpgt_epi32(high, at)));
    }
    static constexpr std::uint32_t kBits = 2;
    ACDF_LANE_MEMBER void store(std::int32_t* out) const {
        _mm256_storeu_si256((__m256i*)(void*)out, _mm256_permute2x128_si256(low, high, 0x20));
        _mm256_storeu_si256((__m256i*)(void*)(out + 8), _mm256_permute2x128_si256(low, high, 0x31));
    }
#endif
};

ACDF_LANE __m256i sixteen_words(const std::uint16_t* at) {
    return _mm256_loadu_si256((const __m256i*)(const void*)at);
}
ACDF_LANE __m256i sixteen_widened(const std::uint8_t* at) {
    return _mm256_cvtepu8_epi16(_mm_loadu_si128((const __m128i*)(const void*)at));
}

/* acdf_fast_search of three rows. */
ACDF_LANE std::uint32_t search_words(const std::uint16_t* const row[kRows], std::uint32_t first, std::int32_t pair,
                                     std::int32_t last, std::int32_t x) {
    for (;; first += 16) {
        Sixteen ends;
        ends.mix(sixteen_words(row[0] + first), sixteen_words(row[1] + first), sixteen_words(row[2] + first), pair,
                 last);
        const std::uint32_t mask = ends.above(x);
        if (mask) return first + acdf_lowest_bit(mask) / Sixteen::kBits;
    }
}

/* acdf_fast_end_of: the first of a list of ends that is at least `least`. 64 bytes from its start may be read. */
ACDF_LANE std::uint32_t end_at_least(const std::uint8_t* ends, std::int32_t least) {
#if ACDF_WIDTH == 8
    const __mmask64 mask =
        _mm512_cmpge_epu8_mask(_mm512_loadu_si512((const void*)ends), _mm512_set1_epi8((char)least));
    return (std::uint32_t)__builtin_ctzll(mask);
#else
    const __m256i key = _mm256_set1_epi8((char)least);
    for (std::uint32_t first = 0;; first += 32) {
        const __m256i some = _mm256_loadu_si256((const __m256i*)(const void*)(ends + first));
        const __m256i is = _mm256_cmpeq_epi8(_mm256_max_epu8(some, key), some);
        const auto mask = (std::uint32_t)_mm256_movemask_epi8(is);
        if (mask) return first + acdf_lowest_bit(mask);
    }
#endif
}

// ---- shading points --------------------------------------------------------------------------------------------

/// Points of the fast shape: what AcdfFastMixture and AcdfLocalPoint have of it, and addresses. Bright tiles are
/// those that LightLanes do not add.
template <bool Draws>
struct FastPoints : Corners {
    static constexpr bool kEach = false;
    Integer group[kRows], tile[kRows], upper[Draws ? kRows : 1];
    Ints share[kRows]; // AcdfFastMixture::weight
    Vector whole, mixture, bright_tiles, sum, step, unit;
    Integer others; // in the lower halves, AcdfFacet::others
};

/* acdf_fast_mix */
template <bool Draws>
ACDF_LANE void mix_rows(Vector mixture, FastPoints<Draws>* out) {
    const Vector scale = (Vector)(((2 * 1023 + 13) - (Integer)((Unsigned)mixture >> 52)) << 52);
    Ints whole = {};
    for (int i = 0; i < kRows; ++i) whole += out->share[i] = to_integers(out->weight[i] * scale) + 1;
    out->whole = to_doubles(whole);
}

/* Of the sum of all. */
ACDF_LANE Vector unit_of(Vector mixture, Vector sum, Vector whole) {
    return mixture / (sum * (32767.0 * 255.0 * whole));
}

/* acdf_local_at of files of the fast shape, but for its corners. */
template <bool Draws>
ACDF_LANE void set_points(const AcdfLocal& local, FastPoints<Draws>* out) {
    const AcdfFast& fast = local.fast;
    for (int i = 0; i < kRows; ++i) {
        out->group[i] = multiplied(out->row[i], 2ll * fast.ends) + (long long)(std::uintptr_t)fast.groups;
        out->tile[i] = multiplied(out->row[i], fast.stride) + (long long)(std::uintptr_t)fast.tiles;
        if (Draws)
            out->upper[i] = multiplied(out->row[i], 2ll * fast.upper_ends) + (long long)(std::uintptr_t)fast.upper;
    }
    out->mixture = (out->weight[0] + out->weight[1]) + out->weight[2];
    mix_rows(out->mixture, out);
    leave_others(local, out);
    out->sum = out->bright_tiles + out->mixture;
    if (Draws) out->step = 32767.0 * out->whole / out->mixture;
    out->unit = unit_of(out->mixture, out->sum, out->whole);
}

/* One point in all lanes, which serves_batches has approved. */
template <bool Draws>
ACDF_LANE void points_of(const AcdfLocal&, const AcdfLocalPoint& point, FastPoints<Draws>* out) {
    const AcdfFastMixture& mix = point.by.fast.mix;
    for (int i = 0; i < kRows; ++i) {
        out->group[i] = Integer{} + (long long)(std::uintptr_t)mix.group[i];
        out->tile[i] = Integer{} + (long long)(std::uintptr_t)mix.tile[i];
        if (Draws) out->upper[i] = Integer{} + (long long)(std::uintptr_t)mix.upper[i];
        out->share[i] = Ints{} + mix.weight[i];
    }
    const AcdfScaledNormal normal = acdf_local_scaled_normal(&point);
    for (int i = 0; i < 3; ++i) out->normal[i] = all(normal.normal[i]);
    out->length = all(normal.length);
    out->facet = Integer{}; // any: the point has its bright tiles
    out->whole = all(mix.whole);
    out->bright_tiles = all(point.bright_tiles);
    out->others = Integer{};
    out->mixture = all(0.0); // of others alone
    out->sum = all(point.sum);
    out->step = all(point.by.fast.step);
    out->unit = all(point.by.fast.unit);
    out->served = ~Integer{};
}

// ---- what rows give --------------------------------------------------------------------------------------------

/// What lanes of a block in the fast shape have of their rows.
struct FastLanes {
    alignas(64) long long group[kRows][kRoom], tile_row[kRows][kRoom];
    alignas(64) std::int32_t share[kRows][kRoom];
    alignas(64) double unit[kRoom];
};

/// What lanes have of their points.
struct FastPointLanes {
    FastLanes rows;
    LightLanes bright_tiles;
    alignas(64) double whole[kRoom];
    alignas(64) long long facet[kRoom]; // of samples: in which byte of all it begins
};

/* Keeps the points of a vector from a lane on. */
template <bool Draws>
ACDF_LANE void keep_points(const FastPoints<Draws>& p, std::size_t at, FastPointLanes* l) {
    for (int i = 0; i < kRows; ++i) {
        stored(&l->rows.group[i][at], p.group[i]);
        stored(&l->rows.tile_row[i][at], p.tile[i]);
        stored(&l->rows.share[i][at], p.share[i]);
    }
    stored(&l->rows.unit[at], p.unit);
    keep_lights(p, at, &l->bright_tiles);
    stored(&l->whole[at], p.whole);
    if (Draws) stored(&l->facet[at], p.facet);
}

/* What other bright tiles change of them. */
ACDF_LANE void end_points(const AcdfLocal& local, FastPointLanes* l) {
    add_other_lights(local, &l->bright_tiles, [l](const long long* lane, Integer at, Vector mixture, Vector sum) {
        alignas(64) double unit[ACDF_WIDTH];
        stored(unit, unit_of(mixture, sum, gathered_doubles(l->whole, at)));
        for (int i = 0; i < ACDF_WIDTH; ++i) l->rows.unit[lane[i]] = unit[i];
    });
}

/// Groups of a vector: the weights of rows in them, what all have of them, and of those before.
struct FastGroups {
    Ints part[kRows];
    Vector mass, below, whole; // whole: of weights
};

/* What a row gives to the group of a lane: cumulative values before and at its end, as they lie; of the first one
 * those at its end and the next one's. */
ACDF_LANE std::int32_t ends_of(const FastLanes& w, int row, std::size_t lane, std::uint32_t number) {
    std::int32_t both;
    std::memcpy(&both, (const std::uint16_t*)w.group[row][lane] + (number - (number > 0)), sizeof both);
    return both;
}

/* acdf_fast_find_group of a vector of groups by their ends; inner: all ones where a group is not the first. */
ACDF_LANE FastGroups find_groups(const FastLanes& w, const Ints given[kRows], Ints inner, std::size_t at) {
    FastGroups out;
    Ints mass = {}, below = {}, whole = {};
    for (int i = 0; i < kRows; ++i) {
        const Ints ends = given[i], share = loaded(&w.share[i][at]);
        const Ints before = ends & inner & 0xFFFF, end = (ends >> (inner & 16)) & 0xFFFF;
        out.part[i] = (end - before) * share;
        mass += out.part[i];
        below += before * share;
    }
    const Ints shift = shift_of(mass), most = ((Ints{} + 1) << shift) - 1;
    for (Ints& part : out.part) {
        part = (part + most) >> shift;
        whole += part;
    }
    out.mass = to_doubles(mass);
    out.below = to_doubles(below);
    out.whole = to_doubles(whole);
    return out;
}

} // namespace
