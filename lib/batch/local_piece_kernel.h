// Pdfs of LocalBatch over vectors, of files that have pieces of cells: acdf_local_table_pdf of
// acdf/local.h, operation by operation; see local_kernel.h. Only the first piece that may hold a direction is
// looked at.
#pragma once

#include "batch/local_pdf_kernel.h"
#include "batch/search_vectors.h"

#include <algorithm>
#include <cstring>

namespace {

/// The directions of a block in their pieces.
struct PieceLanes {
    Sought sought;
    alignas(64) float along[kSearched], cap[kSearched];
    alignas(64) double probability[kSearched],
        area[kSearched]; // of the piece's cell in its tile; see AcdfTilePiece
    alignas(64) long long tile[kSearched];
};

/* acdf_keys_of_direction of all lanes, and the blocks that lead to their pieces. Returns the lanes that floats
 * cannot decide. */
ACDF_LANE std::uint32_t find_places(const AcdfLocalTables& tables, const Search& s, const float (*directions)[3],
                                    PieceLanes* lanes) {
    std::uint32_t refused = 0;
    for (std::size_t first = 0; first < kSearched; first += kLanes) {
        Floats w[3];
        Words key[2];
        load_vectors(directions + first, w);
        refused |= bits(direction_place(tables.octahedral != 0, w, (Floats*)&lanes->along[first],
                                        (Floats*)&lanes->cap[first], key))
                   << first;
        find_blocks(s, key[0], key[1], &lanes->sought, first);
    }
    return refused;
}

/* Looks at the pieces that were found, and asks for what rows give to their tiles. Returns the lanes that lie
 * elsewhere. */
ACDF_LANE std::uint32_t enter_pieces(const AcdfTilePiece* pieces, const long long (*parts)[kRoom],
                                     PieceLanes* lanes) {
    std::uint32_t lost = 0;
    for (std::size_t i = 0; i < kSearched; ++i) {
        const AcdfTilePiece& piece = pieces[lanes->sought.cell[i]];
        const float d0 = piece.origin[0] - lanes->along[i], d1 = lanes->cap[i] - piece.origin[1];
        const std::uint32_t held0 = acdf_float_bits(d0) < acdf_float_bits(piece.width[0]);
        const std::uint32_t held1 = acdf_float_bits(d1) < acdf_float_bits(piece.width[1]);
        lost |= (~(held0 & held1) & 1u) << i;
        lanes->tile[i] = piece.tile;
        lanes->probability[i] = piece.probability;
        lanes->area[i] = piece.area;
        for (int k = 0; k < kRows; ++k) ACDF_PREFETCH((const double*)parts[k][i] + piece.tile);
    }
    return lost;
}

/* The addresses of what a vector of rows give to tiles. */
ACDF_LANE Integer parts_of(const AcdfLocal& local, Integer row) {
    const auto parts = (long long)(std::uintptr_t)acdf_local_parts(local.tables, 0, 0);
    return multiplied(row, 8ll * local.blend.tiles->tile_count) + parts;
}

/* Pdfs of up to kSearched lanes; `at` and `alone` as in draw_block. */
template <class At, class Alone>
ACDF_LANE void piece_block(const AcdfLocal& local, const Search& s, const At& at, const Alone& alone,
                           const float (*directions)[3], std::size_t count, float* out) {
    const auto* const pieces = (const AcdfTilePiece*)(const void*)(s.tables + local.tables->pieces);
    Seen seen;
    PieceLanes lanes;
    float last[kSearched][3] = {};
    alignas(64) double given[kRoom], probability[kRoom];
    if (count < kSearched) std::memcpy(last, directions, count * sizeof *directions);
    std::uint32_t lost = find_places(*local.tables, s, count < kSearched ? last : directions, &lanes);
    ask_for_blocks(s, lanes.sought);
    at(count, count, [&](const Points<false>& p, std::size_t first) {
        keep(p, first, &seen);
        for (int k = 0; k < kRows; ++k) stored(&seen.row[k][first], parts_of(local, p.row[k]));
        lost |= (std::uint32_t)not_served(p, first);
    });
    end_points(local, &seen);
    lost |= find_cells(s, &lanes.sought, [pieces](std::size_t piece) { ACDF_PREFETCH(pieces + piece); });
    for (std::size_t i = (count + ACDF_WIDTH - 1) / ACDF_WIDTH * ACDF_WIDTH; i < kSearched; ++i)
        for (int k = 0; k < kRows; ++k) seen.row[k][i] = seen.row[k][0];
    lost |= enter_pieces(pieces, seen.row, &lanes);
    for (std::size_t first = 0; first < count; first += ACDF_WIDTH) {
        const Integer tile = loaded(&lanes.tile[first]) * 8;
        Vector share = all(0.0);
        for (int k = 0; k < kRows; ++k)
            share += loaded(&seen.weight[k][first]) * (Vector)loaded_at(loaded(&seen.row[k][first]) + tile);
        stored(&given[first], share);
    }
    weigh_tiles(local, seen, lanes.tile, given, count, probability);
    for (std::size_t first = 0; first < kSearched; first += kLanes) {
        Vector pdf[2];
        for (std::size_t half = 0; half < 2; ++half) {
            const std::size_t i = first + ACDF_WIDTH * half;
            const Vector of_tile = loaded(&probability[i]), of_cell = loaded(&lanes.probability[i]);
            const Mask some = both(less(all(0.0), of_tile), less(all(0.0), of_cell));
            pdf[half] = choose(
                some, area_pdf(positive(of_tile * of_cell), local.environment.columns, loaded(&lanes.area[i])),
                all(0.0));
        }
        alignas(64) float told[kLanes];
        *(Floats*)told = to_floats((Doubles)pdf[0], (Doubles)pdf[1]);
        if (first < count) std::memcpy(out + first, told, std::min(count - first, kLanes) * sizeof *out);
    }
    leave_alone(lost, count, alone);
}

// ---- all of an array -------------------------------------------------------------------------------------------

/* Pdfs by pieces where a file has them; `of`: normals, one each, or the point of all. */
template <class Of>
ACDF_LANE void pdf_all(const AcdfLocal& local, Of of, const float (*directions)[3], std::size_t count, float* out) {
    if (local.tables->pieces) {
        const Search s = search_of(local.tables, local.tables->directions);
        pdfs_in_blocks<kSearched, Points<false>>(local, of, directions, count, out,
                                                 [&](const auto&... rest) { piece_block(local, s, rest...); });
    } else {
        pdfs_in_blocks<kBlock, Points<false>>(local, of, directions, count, out,
                                              [&](const auto&... rest) { pdf_block(local, rest...); });
    }
}

} // namespace
