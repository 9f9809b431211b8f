// The loops of EnvironmentWavefront over vectors of ACDF_WIDTH doubles or twice as many floats, by the extensions
// of GCC and Clang. Included by one source a set of instructions, compiled for it; nothing here may be inline with
// external linkage, lest the linker picks code that the processor does not have.
//
// Each function is that of the same name in acdf/pieces.h, acdf/shader_square.h and acdf/cells.h, a lane an
// element, operation by operation: results agree bit for bit. The boxes of a block are compared lane by lane, all
// else is done for all lanes at a time. Of the cells that may hold a point only the first is looked at: what lies
// in another, some two lanes in a hundred, or is not answered by tables, is left to the functions of acdf/sample.h.
#pragma once

#include "waves/alone.h"
#include "waves/environment.h"
#include "waves/piece_vectors.h"
#include "waves/search_vectors.h"

#include <cstring>

namespace {

// ---- drawing ---------------------------------------------------------------------------------------------------

/// Numbers that are drawn with: on their way to pieces.
struct Draws {
    Sought sought;
    Doubles shifted[kSearched / kLanes][2][2]; // as load_numbers gives them
    std::uint32_t lost;                        // bits of lanes that tables do not answer
};

/* acdf_draw_distance of lanes: exact in doubles, then rounded once. */
ACDF_LANE Floats draw_distance(const Doubles shifted[2][2], int axis, Words low) {
    Doubles d[2];
    for (int half = 0; half < 2; ++half)
        d[half] = (shifted[half][axis] - 1.0) * 0x1p52 - to_doubles((Signed)low, half) * 0x1p21;
    return to_floats(d[0], d[1]);
}

/* acdf_cells_sample of lanes by the cells that were found. Returns those that it does not answer. */
ACDF_LANE std::uint32_t draw(const AcdfCells* cells, const Search& s, const Draws& draws, std::size_t first,
                             AcdfDirectionSample* out) {
    const auto* const pieces = (const AcdfPiece*)(const void*)(s.tables + cells->pieces);
    Floats piece[8], direction[3];
    load_pieces(pieces, &draws.sought.cell[first], piece);
    const Doubles(&shifted)[2][2] = draws.shifted[first / kLanes];
    const Floats d0 = draw_distance(shifted, 0, (Words)piece[0]), d1 = draw_distance(shifted, 1, (Words)piece[4]);
    const Words width0 = (Words)piece[1], width1 = (Words)piece[5];
    const Signed held = ((Words)d0 < width0) & (((Words)d1 ^ width1 << 31) < width1);
    const Floats along = piece[2] + d0 * piece[3], height = piece[6] + d1 * piece[7];
    if (cells->octahedral) square_direction(along, height, direction);
    else piece_direction(along, height, width0 & 3u, width1 & 1u, direction);
    store_samples(direction,
                  (Floats)gathered(s.tables + cells->densities, *(const Words*)&draws.sought.cell[first]),
                  out + first);
    return bits(~held) << first;
}

ACDF_LANE void sample_by_cells(const AcdfEnvironment& env, const double (*u)[2], std::size_t count,
                               AcdfDirectionSample* out) {
    const Search s = search_of(env.cells, env.cells->numbers);
    const std::uint32_t* const pieces = s.tables + env.cells->pieces;
    in_stages<Draws>(
        u, count, out,
        [&](const double(*from)[2], Draws* draws) {
            draws->lost = 0;
            for (std::size_t first = 0; first < kSearched; first += kLanes) {
                Words key[2];
                draws->lost |= load_numbers(from + first, draws->shifted[first / kLanes], key) << first;
                find_blocks(s, key[0], key[1], &draws->sought, first);
            }
            ask_for_blocks(s, draws->sought);
        },
        [&](Draws* draws) {
            draws->lost |=
                find_cells(s, &draws->sought, [&](std::size_t cell) { ACDF_PREFETCH(pieces + 8 * cell); });
        },
        [&](const double(*from)[2], Draws* draws, AcdfDirectionSample* to) {
            std::uint32_t lost = draws->lost;
            for (std::size_t first = 0; first < kSearched; first += kLanes)
                lost |= draw(env.cells, s, *draws, first, to);
            for (; lost; lost &= lost - 1) {
                const std::uint32_t i = acdf_lowest_bit(lost);
                to[i] = acdf::alone::environment_sample(env, from[i]);
            }
        });
}

// ---- finding ---------------------------------------------------------------------------------------------------

/// Where directions lie, an AcdfPlace a lane: on their way to pieces.
struct Places {
    Sought sought;
    Floats along[kSearched / kLanes], cap[kSearched / kLanes];
    std::uint32_t lost;
};

/* Where directions lie, and the blocks of them. Returns the lanes of which floats do not tell. */
ACDF_LANE std::uint32_t find_directions(const AcdfCells* cells, const Search& s, const float (*directions)[3],
                                        std::size_t first, Places* places) {
    Floats w[3];
    Words key[2];
    load_vectors(directions + first, w);
    const std::uint32_t refused = bits(direction_place(cells->octahedral != 0, w, &places->along[first / kLanes],
                                                       &places->cap[first / kLanes], key));
    find_blocks(s, key[0], key[1], &places->sought, first);
    return refused << first;
}

/* acdf_cells_pdf of lanes by the cells that were found. Returns those that it does not answer. */
ACDF_LANE std::uint32_t densities(const AcdfCells* cells, const Search& s, const Places& places, std::size_t first,
                                  float* out) {
    const auto* const pieces = (const AcdfPiece*)(const void*)(s.tables + cells->pieces);
    Floats piece[8];
    load_pieces(pieces, &places.sought.cell[first], piece);
    const Floats d0 = piece[2] - places.along[first / kLanes], d1 = places.cap[first / kLanes] - piece[6];
    const Floats width0 = -(piece[1] * piece[3]), width1 = absolute(piece[5] * piece[7]);
    const Signed held = ((Words)d0 < (Words)width0) & ((Words)d1 < (Words)width1);
    const Words pdf = gathered(s.tables + cells->densities, *(const Words*)&places.sought.cell[first]);
    std::memcpy(out + first, &pdf, sizeof pdf);
    return bits(~held) << first;
}

ACDF_LANE void pdf_by_cells(const AcdfEnvironment& env, const float (*w)[3], std::size_t count, float* out) {
    const Search s = search_of(env.cells, env.cells->directions);
    const std::uint32_t* const pieces = s.tables + env.cells->pieces;
    in_stages<Places>(
        w, count, out,
        [&](const float(*from)[3], Places* places) {
            places->lost = 0;
            for (std::size_t first = 0; first < kSearched; first += kLanes)
                places->lost |= find_directions(env.cells, s, from, first, places);
            ask_for_blocks(s, places->sought);
        },
        [&](Places* places) {
            places->lost |=
                find_cells(s, &places->sought, [&](std::size_t cell) { ACDF_PREFETCH(pieces + 8 * cell); });
        },
        [&](const float(*from)[3], Places* places, float* to) {
            std::uint32_t lost = places->lost;
            for (std::size_t first = 0; first < kSearched; first += kLanes)
                lost |= densities(env.cells, s, *places, first, to);
            for (; lost; lost &= lost - 1) {
                const std::uint32_t i = acdf_lowest_bit(lost);
                to[i] = acdf::alone::environment_pdf(env, from[i]);
            }
        });
}

} // namespace
