// What samples and pdfs of LocalBatch share: lanes in tiles and in cells, and pdfs of cells. Internal
// linkage: see local_kernel.h.
#pragma once

#include "batch/local_point_vectors.h"

#include <cstddef>

namespace {

constexpr std::size_t kBlock = 64, kRoom = kBlock + ACDF_WIDTH; // lanes, and what is written behind them

/// Lanes in tiles.
struct Cells {
    std::size_t count;
    alignas(64) double u[2][kRoom], probability[kRoom]; // of the tile
    alignas(64) long long square[2][kRoom], lane[kRoom], tile[kRoom];
};

/// Lanes in cells, in the order of the tiles that those are in.
struct Boxes {
    std::size_t count;
    alignas(64) double u[2][kRoom], product[kRoom]; // product: of the curves
    alignas(64) long long low[2][kRoom], high[2][kRoom];
    bool lost[kRoom]; // left to the single call
};

/* Ends a list of cells: what stands behind the last one is one of the file, too. */
ACDF_LANE void end_boxes(std::size_t count, Boxes* boxes) {
    boxes->count = count;
    for (std::size_t i = count; i % kLanes > 0; ++i) {
        for (int axis = 0; axis < 2; ++axis) boxes->low[axis][i] = boxes->high[axis][i] = 0;
    }
}

/* Probabilities of cells, by those of their tiles, which are above 0, as are the products. */
ACDF_LANE Vector probabilities(const Cells& cells, const Boxes& done, std::size_t at) {
    return positive(loaded(&cells.probability[at]) * positive(loaded(&done.product[at])));
}

/* acdf_area_pdf of doubles that are floats already. */
ACDF_LANE Vector area_pdf(Vector p, double columns, Vector area) {
    const Vector pdf = p * columns / area;
    return select(pdf >= 3.402823466e38, all((double)3.402823466e38f),
                  select(pdf > 1.17549435e-38, pdf, all((double)1.17549435e-38f)));
}

/* Of a cell, as acdf_row_pdf and acdf_grid_pdf of cells without tilts form it. */
ACDF_LANE Vector row_area(Vector width, Vector z0, Vector z1) { return 2.0 * ACDF_PI * width * (z0 - z1); }
ACDF_LANE Vector fold_area(Vector width, Vector height, double rows) {
    return 2.0 * ACDF_PI * width * (2.0 * height / rows);
}

} // namespace
