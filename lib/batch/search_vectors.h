// acdf/squares.h over vectors: the entries of grids are loaded for all lanes at a time, the boxes of a block
// compared lane by lane. Internal linkage: see shared_vectors.h.
#pragma once

#include "batch/shared_vectors.h"

#include <acdf/squares.h>

namespace {

constexpr std::size_t kSearched = 32; // points that are searched for at a time: loads do not wait for each other

/// The grids and cells of one kind of key.
struct Search {
    const std::uint32_t *tables, *grid;
    const char *boxes, *cells;
    const AcdfSquares* squares;
};

ACDF_LANE Search search_of(const void* all, const AcdfSquares& squares) {
    const auto* const tables = (const std::uint32_t*)all;
    return {tables, tables + squares.grid, (const char*)(tables + squares.boxes),
            (const char*)(tables + squares.cells), &squares};
}

/// Of the lanes of a block: the number of a block of boxes, where in it a point lies (bytes that turn comparisons
/// with all four kinds of sides into "greater"), and the first cell that may hold it.
struct Sought {
    alignas(64) std::uint32_t block[kSearched], bytes[kSearched], cell[kSearched];
};

/* acdf_squares_entry of lanes, and what is to be compared. The blocks are asked for. */
ACDF_LANE void find_blocks(const Search& s, Words key0, Words key1, Sought* sought, std::size_t first) {
    Words entry = gathered(s.grid, ((key1 >> s.squares->shift1) << s.squares->bits0) + (key0 >> s.squares->shift0));
    std::uint32_t finer = bits((Signed)entry < 0);
    for (; __builtin_expect(finer != 0, 0); finer &= finer - 1) {
        const std::uint32_t i = acdf_lowest_bit(finer);
        entry[i] = acdf_squares_entry(s.tables, s.squares, key0[i], key1[i]);
    }
    const Words byte0 = (shifted_right(key0, entry >> 26) & 0xFFu) ^ 0x80u;
    const Words byte1 = (shifted_right(key1, entry >> 21 & 31u) & 0xFFu) ^ 0x80u;
    *(Words*)&sought->block[first] = entry & ACDF_SQUARES_BLOCK_MASK;
    *(Words*)&sought->bytes[first] = (byte0 | byte0 << 8 | byte1 << 16 | byte1 << 24) ^ 0xFF00FF00u;
}

ACDF_LANE void ask_for_blocks(const Search& s, const Sought& sought) {
    for (std::size_t i = 0; i < kSearched; ++i) {
        ACDF_PREFETCH(s.boxes + 64 * std::size_t{sought.block[i]});
        ACDF_PREFETCH(s.cells + 32 * std::size_t{sought.block[i]});
    }
}

/* acdf_squares_candidates of the 16 cells whose boxes stand somewhere, by what each axis is compared with: the byte
 * of a point less 128 with lower sides, and turned with upper ones. */
ACDF_LANE std::uint32_t candidates(const void* boxes, __m256i at0, __m256i at1) {
    const __m256i turned = _mm256_set_m128i(_mm_set1_epi8(-1), _mm_setzero_si128());
    const auto* const box = (const __m256i*)boxes;
    const __m256i out0 = _mm256_cmpgt_epi8(_mm256_xor_si256(_mm256_load_si256(box), turned), at0);
    const __m256i out1 = _mm256_cmpgt_epi8(_mm256_xor_si256(_mm256_load_si256(box + 1), turned), at1);
    const __m256i out = _mm256_or_si256(out0, out1);
    const __m128i either = _mm_or_si128(_mm256_castsi256_si128(out), _mm256_extracti128_si256(out, 1));
    return (std::uint32_t)_mm_movemask_epi8(either) ^ 0xFFFFu;
}

/* Bit k: whether cell k of lane i's block may hold its point. */
ACDF_LANE std::uint32_t candidates_of(const Search& s, const Sought& sought, std::size_t i) {
    const __m256i axis0 = _mm256_set_m128i(_mm_set1_epi8(1), _mm_set1_epi8(0));
    const __m256i axis1 = _mm256_set_m128i(_mm_set1_epi8(3), _mm_set1_epi8(2));
    const __m256i at = _mm256_set1_epi32((std::int32_t)sought.bytes[i]);
    return candidates(s.boxes + 64 * std::size_t{sought.block[i]}, _mm256_shuffle_epi8(at, axis0),
                      _mm256_shuffle_epi8(at, axis1));
}

/* The first cell of each lane's block that may hold its point, or any where there is none, which `next` is given.
 * Returns the lanes that have none: what any cell has for their positions applies to other quarters, too. */
template <class Next>
ACDF_LANE std::uint32_t find_cells(const Search& s, Sought* sought, const Next& next) {
    std::uint32_t gaps = 0, none = 0; // gaps: its highest bit
    for (std::size_t i = 0; i < kSearched; ++i) {
        const std::uint32_t mask = candidates_of(s, *sought, i);
        const auto* const list = (const std::uint16_t*)(const void*)(s.cells + 32 * std::size_t{sought->block[i]});
        gaps |= mask - 1u;
        next(sought->cell[i] = list[acdf_lowest_bit(mask | 0x8000u)]);
    }
    if (__builtin_expect(gaps >> 31, 0))
        for (std::size_t i = 0; i < kSearched; ++i) none |= (std::uint32_t)(candidates_of(s, *sought, i) == 0) << i;
    return none;
}

} // namespace
