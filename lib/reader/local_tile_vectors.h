// What draws and densities of LocalWavefront share: tiles that are entered, and densities of cells. Internal
// linkage: see local_kernel.h.
#pragma once

#include "local_curve_vectors.h"
#include "local_point_vectors.h"

namespace {

/// Lanes in tiles.
struct Cells {
    std::size_t count;
    alignas(64) double u[2][kRoom], probability[kRoom]; // of the tile
    alignas(64) long long square[2][kRoom], lane[kRoom], tile[kRoom];
};

/* Enters the tiles, whose curves are asked for: those that are cells are done. */
template <bool Finds>
ACDF_LANE void enter_tiles(const AcdfLocal& local, const Cells& cells, Boxes* live, Boxes* done) {
    live->count = done->count = 0;
    for (std::size_t i = 0; i < cells.count; ++i) {
        const AcdfTileRecord* const tile = acdf_local_tile(local.tables, (std::uint32_t)cells.tile[i]);
        Boxes* const to = tile->root == ACDF_NO_ROOT ? done : live;
        const std::size_t at = to->count++;
        acdf_local_ahead(&local, tile);
        for (int axis = 0; axis < 2; ++axis) {
            if (Finds) to->square[axis][at] = cells.square[axis][i];
            else to->u[axis][at] = cells.u[axis][i];
            to->low[axis][at] = tile->low[axis];
            to->high[axis][at] = tile->high[axis];
        }
        to->product[at] = 1.0;
        to->curve[at] = tile->root;
        to->number[at] = (long long)i;
    }
}

/* Ends a list of cells: what stands behind the last one is one of the file, too. */
ACDF_LANE void end_boxes(std::size_t count, Boxes* boxes) {
    boxes->count = count;
    for (std::size_t i = count; i % kLanes > 0; ++i) {
        boxes->number[i] = 0;
        for (int axis = 0; axis < 2; ++axis) boxes->low[axis][i] = boxes->high[axis][i] = 0;
    }
}

/* Follows the curves of all tiles. */
template <bool Finds>
ACDF_LANE void find_cells(const AcdfLocal& local, Boxes* live, Boxes* done) {
    follow_all<Finds>(local.blend.tree, local.environment.tree_units, live, done);
    end_boxes(done->count, done);
}

/* Their probabilities, by those of the tiles, which are above 0, as are the products. */
ACDF_LANE Vector probabilities(const Cells& cells, const Boxes& done, std::size_t at) {
    return positive((Vector)loaded_from(cells.probability, loaded(&done.number[at])) *
                    positive(loaded(&done.product[at])));
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
