// Samples from cuts of the fast shape over vectors, and their pdfs: acdf/product/fast_cut.h, operation by
// operation; see local_kernel.h. Parts and tiles are found lane by lane, cells and directions by vectors, as
// fast_kernel.h has them.
#pragma once

#include "batch/fast_kernel.h"
#include "batch/fast_pdf_kernel.h"
#include "product/vectors/alone.h"

#include <acdf/product/fast_cut.h>

namespace {

/* Any sample or pdf, for lanes behind the last one. */
ACDF_LANE void pad_lanes(std::size_t count, FastCells* c) {
    for (std::size_t i = count; i % kLanes != 0; ++i) {
        c->u[0][i] = c->u[1][i] = 0.0;
        c->of[i] = c->all[i] = 1.0;
    }
}

/* acdf_fast_cut_sample of up to kBlock lanes. */
ACDF_LANE void draw_cut_block(const AcdfLocal& local, const AcdfLocalPoint& point, const AcdfFastCut& cut,
                              const double (*u)[2], std::size_t count, AcdfDirectionSample* out) {
    FastDraws d;
    FastCells& c = d.cells;
    for (std::size_t i = 0; i < count; ++i) {
        AcdfFastShare share;
        double left[2];
        d.tile[i] = (std::int32_t)acdf_fast_cut_choose_part(&local, &point, &cut, u[i], left, &share);
        ACDF_PREFETCH(acdf_local_tile(local.tables, (std::uint32_t)d.tile[i]));
        for (int axis = 0; axis < 2; ++axis) c.u[axis][i] = left[axis];
        c.of[i] = share.of;
        c.all[i] = share.all * ACDF_FAST_STEPS;
    }
    for (std::size_t i = count; i % kLanes != 0; ++i) d.tile[i] = d.tile[0];
    pad_lanes(count, &c);
    end_draws(
        local, &d, 0, [&](std::size_t i) { out[i] = acdf::alone::cut_sample(local, point, cut, u[i]); }, count,
        out);
}

/* acdf_fast_cut_pdf of up to kBlock lanes. */
ACDF_LANE void cut_pdf_block(const AcdfLocal& local, const AcdfLocalPoint& point, const AcdfFastCut& cut,
                             const float (*directions)[3], std::size_t count, float* out) {
    FastSquares f;
    const std::size_t whole = (count + kLanes - 1) / kLanes * kLanes;
    const std::uint64_t lost = find_squares(local, directions, count, &f);
    find_fast_tiles(local, whole, &f);
    find_fast_cells(whole, &f);
    for (std::size_t i = 0; i < count; ++i) {
        const AcdfFastShare share =
            acdf_fast_cut_find(&point, &cut, (std::uint32_t)f.tile[i], f.cells.tile[i]->light);
        f.cells.of[i] = share.of;
        f.cells.all[i] = share.all * ACDF_FAST_STEPS;
    }
    pad_lanes(count, &f.cells);
    store_pdfs(local, f.cells, count, out);
    leave_alone(lost, count,
                [&](std::size_t i) { out[i] = acdf::alone::cut_pdf(local, point, cut, directions[i]); });
}

// ---- all of an array -------------------------------------------------------------------------------------------

ACDF_LANE void sample_all_of_cut(const AcdfLocal& local, const AcdfLocalPoint& point, const AcdfFastCut& cut,
                                 const double (*u)[2], std::size_t count, AcdfDirectionSample* out) {
    for (std::size_t first = 0; first < count; first += kBlock)
        draw_cut_block(local, point, cut, u + first, std::min<std::size_t>(count - first, kBlock), out + first);
}

ACDF_LANE void pdf_all_of_cut(const AcdfLocal& local, const AcdfLocalPoint& point, const AcdfFastCut& cut,
                              const float (*directions)[3], std::size_t count, float* out) {
    for (std::size_t first = 0; first < count; first += kBlock)
        cut_pdf_block(local, point, cut, directions + first, std::min<std::size_t>(count - first, kBlock),
                      out + first);
}

} // namespace
