// The loops of EnvironmentWavefront over vectors of ACDF_WIDTH doubles or twice as many floats, by the extensions
// of GCC and Clang. Included by one source a set of instructions, compiled for it; nothing here may be inline with
// external linkage, lest the linker picks code that the processor does not have.
//
// Each function is that of the same name in acdf/pieces.h, acdf/shader_square.h and acdf/cells.h, a lane an
// element, operation by operation: results agree bit for bit. The boxes of a block are compared lane by lane, all
// else is done for all lanes at a time. Of the cells that may hold a point only the first is looked at: what lies
// in another, some two lanes in a hundred, or is not answered by tables, is left to the functions of acdf/sample.h.
#pragma once

#include "environment_wavefront.h"
#include "piece_vectors.h"

#include <cstring>

namespace {

constexpr std::size_t kBlock = 32; // points that are searched for at a time: loads do not wait for each other

/// The grids and cells of one kind of key.
struct Search {
    const std::uint32_t *tables, *grid;
    const char *boxes, *cells;
    std::uint32_t at, shift0, shift1, bits0;
};

ACDF_LANE Search search_of(const AcdfCells* cells, const AcdfSquares& squares) {
    const auto* const tables = (const std::uint32_t*)(const void*)cells;
    return {tables,
            tables + squares.grid,
            (const char*)(tables + squares.boxes),
            (const char*)(tables + squares.cells),
            (std::uint32_t)((const std::uint32_t*)(const void*)&squares - tables),
            squares.shift0,
            squares.shift1,
            squares.bits0};
}

/// Of the lanes of a block: the number of a block of boxes, where in it a point lies (bytes that turn comparisons
/// with all four kinds of sides into "greater"), and the first cell that may hold it.
struct Sought {
    alignas(64) std::uint32_t block[kBlock], bytes[kBlock], cell[kBlock];
};

/* acdf_squares_entry of lanes, and what is to be compared. */
ACDF_LANE void find_blocks(const Search& s, Words key0, Words key1, Sought* sought, std::size_t first) {
    Words entry = gathered(s.grid, ((key1 >> s.shift1) << s.bits0) + (key0 >> s.shift0));
    std::uint32_t finer = bits((Signed)entry < 0);
    for (; __builtin_expect(finer != 0, 0); finer &= finer - 1) {
        const std::uint32_t i = acdf_lowest_bit(finer);
        entry[i] = acdf_squares_entry(s.tables, s.at, key0[i], key1[i]);
    }
    const Words byte0 = (shifted_right(key0, entry >> 26) & 0xFFu) ^ 0x80u;
    const Words byte1 = (shifted_right(key1, entry >> 21 & 31u) & 0xFFu) ^ 0x80u;
    *(Words*)&sought->block[first] = entry & ACDF_SQUARES_BLOCK_MASK;
    *(Words*)&sought->bytes[first] = (byte0 | byte0 << 8 | byte1 << 16 | byte1 << 24) ^ 0xFF00FF00u;
}

/* acdf_squares_candidates, of each lane; the first one, or any where there is none. */
ACDF_LANE void find_cells(const Search& s, Sought* sought) {
    const __m256i axis0 = _mm256_set_m128i(_mm_set1_epi8(1), _mm_set1_epi8(0));
    const __m256i axis1 = _mm256_set_m128i(_mm_set1_epi8(3), _mm_set1_epi8(2));
    const __m256i turned = _mm256_set_m128i(_mm_set1_epi8(-1), _mm_setzero_si128());
    for (std::size_t i = 0; i < kBlock; ++i) {
        const std::size_t block = sought->block[i];
        const auto* const box = (const __m256i*)(const void*)(s.boxes + 64 * block);
        const __m256i at = _mm256_set1_epi32((std::int32_t)sought->bytes[i]);
        const __m256i out0 =
            _mm256_cmpgt_epi8(_mm256_xor_si256(_mm256_load_si256(box), turned), _mm256_shuffle_epi8(at, axis0));
        const __m256i out1 =
            _mm256_cmpgt_epi8(_mm256_xor_si256(_mm256_load_si256(box + 1), turned), _mm256_shuffle_epi8(at, axis1));
        const __m256i out = _mm256_or_si256(out0, out1);
        const __m128i either = _mm_or_si128(_mm256_castsi256_si128(out), _mm256_extracti128_si256(out, 1));
        const std::uint32_t mask = ((std::uint32_t)_mm_movemask_epi8(either) ^ 0xFFFFu) | 0x8000u;
        sought->cell[i] = ((const std::uint16_t*)(const void*)(s.cells + 32 * block))[acdf_lowest_bit(mask)];
    }
}

// ---- drawing ---------------------------------------------------------------------------------------------------

/// Random numbers of a block, and 1.
struct Numbers {
    Doubles shifted[kBlock / ACDF_WIDTH][2];
};

/* acdf_draw_distance of lanes: exact in doubles, then rounded once. */
ACDF_LANE Floats draw_distance(const Numbers& n, std::size_t first, int axis, Words low) {
    Doubles d[2];
    for (int half = 0; half < 2; ++half)
        d[half] = (n.shifted[first / ACDF_WIDTH + (std::size_t)half][axis] - 1.0) * 0x1p52 -
                  to_doubles((Signed)low, half) * 0x1p21;
    return to_floats(d[0], d[1]);
}

/* acdf_cells_sample of lanes by the cells that were found. Returns those that it does not answer. */
ACDF_LANE std::uint32_t draw(const AcdfCells* cells, const Search& s, const Sought& sought, const Numbers& n,
                             std::size_t first, AcdfDirectionSample* out) {
    const auto* const pieces = (const AcdfPiece*)(const void*)(s.tables + cells->pieces);
    Floats piece[8], direction[3];
    load_pieces(pieces, &sought.cell[first], piece);
    const Floats d0 = draw_distance(n, first, 0, (Words)piece[0]), d1 = draw_distance(n, first, 1, (Words)piece[4]);
    const Words width0 = (Words)piece[1], width1 = (Words)piece[5];
    const Signed held = ((Words)d0 < width0) & (((Words)d1 ^ width1 << 31) < width1);
    const Floats along = piece[2] + d0 * piece[3], height = piece[6] + d1 * piece[7];
    if (cells->octahedral) square_direction(along, height, direction);
    else piece_direction(along, height, width0 & 3u, width1 & 1u, direction);
    store_samples(direction, (Floats)gathered(s.tables + cells->densities, *(const Words*)&sought.cell[first]),
                  out + first);
    return bits(~held) << first;
}

/* acdf_environment_sample of a block. */
ACDF_LANE void sample_block(const AcdfEnvironment& env, const Search& s, const double (*u)[2],
                            AcdfDirectionSample* out) {
    Sought sought;
    Numbers n;
    std::uint32_t lost = 0;
    for (std::size_t first = 0; first < kBlock; first += kLanes) {
        Words key[2];
        Longs number[2][2]; /* of each half and axis */
        for (std::size_t half = 0; half < 2; ++half) {
            Doubles* const shifted = n.shifted[first / ACDF_WIDTH + half];
            load_pairs(u + first + ACDF_WIDTH * half, shifted);
            for (int axis = 0; axis < 2; ++axis) {
                shifted[axis] = shifted[axis] + 1.0;
                number[half][axis] = (Longs)shifted[axis] ^ 0x3FF0000000000000u;
            }
        }
        for (int axis = 0; axis < 2; ++axis)
            key[axis] = low_words(number[0][axis] >> 21, number[1][axis] >> 21) & 0x7FFFFFFFu;
        const Words high = low_words((number[0][0] | number[0][1]) >> 52, (number[1][0] | number[1][1]) >> 52);
        lost |= bits(high != 0u) << first;
        find_blocks(s, key[0], key[1], &sought, first);
    }
    find_cells(s, &sought);
    for (std::size_t first = 0; first < kBlock; first += kLanes) lost |= draw(env.cells, s, sought, n, first, out);
    for (; lost; lost &= lost - 1) {
        const std::uint32_t i = acdf_lowest_bit(lost);
        out[i] = acdf_environment_sample(&env, u[i][0], u[i][1]);
    }
}

// ---- finding ---------------------------------------------------------------------------------------------------

/// Where directions lie: an AcdfPlace a lane.
struct Places {
    Floats along[kBlock / kLanes], cap[kBlock / kLanes];
};

/* Where directions lie, and the blocks of them. Returns the lanes of which floats do not tell. */
ACDF_LANE std::uint32_t find_directions(const AcdfCells* cells, const Search& s, const float (*directions)[3],
                                        std::size_t first, Places* places, Sought* sought) {
    Floats w[3];
    Words key[2];
    load_vectors(directions + first, w);
    const std::uint32_t refused = bits(direction_place(cells->octahedral != 0, w, &places->along[first / kLanes],
                                                       &places->cap[first / kLanes], key));
    find_blocks(s, key[0], key[1], sought, first);
    return refused << first;
}

/* acdf_cells_pdf of lanes by the cells that were found. Returns those that it does not answer. */
ACDF_LANE std::uint32_t densities(const AcdfCells* cells, const Search& s, const Sought& sought,
                                  const Places& places, std::size_t first, float* out) {
    const auto* const pieces = (const AcdfPiece*)(const void*)(s.tables + cells->pieces);
    Floats piece[8];
    load_pieces(pieces, &sought.cell[first], piece);
    const Floats d0 = piece[2] - places.along[first / kLanes], d1 = places.cap[first / kLanes] - piece[6];
    const Floats width0 = -(piece[1] * piece[3]), width1 = absolute(piece[5] * piece[7]);
    const Signed held = ((Words)d0 < (Words)width0) & ((Words)d1 < (Words)width1);
    const Words pdf = gathered(s.tables + cells->densities, *(const Words*)&sought.cell[first]);
    std::memcpy(out + first, &pdf, sizeof pdf);
    return bits(~held) << first;
}

/* acdf_environment_pdf of a block. */
ACDF_LANE void pdf_block(const AcdfEnvironment& env, const Search& s, const float (*w)[3], float* out) {
    Sought sought;
    Places places;
    std::uint32_t lost = 0;
    for (std::size_t first = 0; first < kBlock; first += kLanes)
        lost |= find_directions(env.cells, s, w, first, &places, &sought);
    find_cells(s, &sought);
    for (std::size_t first = 0; first < kBlock; first += kLanes)
        lost |= densities(env.cells, s, sought, places, first, out);
    for (; lost; lost &= lost - 1) {
        const std::uint32_t i = acdf_lowest_bit(lost);
        out[i] = acdf_environment_pdf(&env, w[i]);
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
