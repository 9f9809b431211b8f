// Pdfs of cuts (acdf/product/cut_sample.h) over vectors, operation by operation. Internal linkage: see
// local_kernel.h.
#pragma once

#include "batch/local_pdf_kernel.h"
#include "product/vectors/alone.h"

#include <acdf/product/cut_batch.h>

namespace {

/* acdf_cut_find of the squares of a vector: numbers of parts. */
ACDF_LANE void find_cut_parts(const AcdfCut& cut, const Cells& cells, std::size_t at, long long* part) {
    static_assert(sizeof(AcdfCutSplit) == 8 && offsetof(AcdfCutSplit, child) == 4);
    const Integer square[2] = {loaded(&cells.square[0][at]), loaded(&cells.square[1][at])};
    const Integer key[2] = {square[0] << 3 | 7, square[1] << 3 | 7}; /* as in acdf_tile_at */
    const Integer splits = Integer{} + (long long)(std::uintptr_t)cut.split;
    Integer node = Integer{} + (cut.count > 1 ? 0 : 0xFFFF);
    for (;;) {
        const Mask ended = has(node, 0x8000);
        if (lanes(ended) + 1 == 1u << ACDF_WIDTH) break;
        const Integer split = loaded_at(splits + choose(ended, Integer{}, node) * 8), place = split & 0xFFFFFFFF;
        const Mask below = negative(choose(has(split, 1), key[1], key[0]) - place);
        node = choose(ended, node, choose(below, split, split >> 16) >> 32 & 0xFFFF);
    }
    stored(part, node ^ 0xFFFF);
}

/* acdf_local_found_tile and acdf_cut_found_probability of all cells. */
ACDF_LANE void weigh_cut_tiles(const AcdfLocal& local, const AcdfLocalPoint& point, const AcdfCut& cut,
                               const long long* number, Cells* cells) {
    const std::uint32_t* const words = acdf_local_words(local.tables);
    for (std::size_t i = 0; i < cells->count; ++i) {
        const AcdfCutPart* const part = &cut.part[number[i]];
        const auto tile = (std::uint32_t)cells->tile[i];
        const AcdfMixture mix = acdf_cut_batch_mixture(part);
        double given = acdf_tile_share_rows(words, &local.tables->tiles, &mix, point.by.tabled.codes, kRows,
                                            acdf_local_tile(local.tables, tile), part->depth);
        if (given > 0.0) given = acdf_positive(given / acdf_mixture_sum(&mix));
        cells->probability[i] = acdf_cut_found_probability(&local, &cut, part, &mix, tile, given);
    }
}

/* acdf_cut_pdf of up to ACDF_CUT_BATCH lanes. */
ACDF_LANE void cut_pdf_block(const AcdfLocal& local, const AcdfLocalPoint& point, const AcdfCut& cut,
                             const float (*directions)[3], std::size_t count, float* out) {
    alignas(64) long long part[kRoom];
    Cells cells;
    Boxes done;
    cells.count = count;
    std::uint64_t lost = find_all_squares(local, directions, count, &cells);
    for (std::size_t at = 0; at < count; at += ACDF_WIDTH) find_cut_parts(cut, cells, at, &part[at]);
    for (std::size_t i = 0; i < count; ++i) acdf_cut_part_ahead(&cut, (int)part[i]);
    ask_for_curves(local, cells);
    weigh_cut_tiles(local, point, cut, part, &cells);
    find_cells<true>(local, cells, &done);
    lost |= pdfs_of(local, cells, done, out);
    for (; lost; lost &= lost - 1) {
        const auto lane = (std::size_t)__builtin_ctzll(lost);
        out[lane] = acdf::alone::cut_pdf(local, point, cut, directions[lane]);
    }
}

ACDF_LANE void cut_pdfs(const AcdfLocal& local, const AcdfLocalPoint& point, const AcdfCut& cut,
                        const float (*directions)[3], std::size_t count, float* out) {
    constexpr std::size_t batch = ACDF_CUT_BATCH;
    for (std::size_t first = 0; first < count; first += batch)
        cut_pdf_block(local, point, cut, directions + first, std::min(count - first, batch), out + first);
}

} // namespace
