// What draws and densities of LocalWavefront share: tiles that are entered, and densities of cells. Internal
// linkage: see local_kernel.h.
#pragma once

#include "local_curves.h"
#include "local_points.h"

namespace {

/* Enters the tiles, whose curves are asked for. */
ACDF_LANE void enter_tiles(const AcdfLocal& local, Cells* cells) {
    for (std::size_t i = 0; i < cells->count; ++i) {
        const AcdfTileRecord* const tile = acdf_local_tile(local.tables, (std::uint32_t)cells->tile[i]);
        for (int axis = 0; axis < 2; ++axis) {
            cells->low[axis][i] = tile->low[axis];
            cells->high[axis][i] = tile->high[axis];
        }
        acdf_local_ahead(&local, tile);
        cells->curve[i] = tile->root == ACDF_NO_ROOT ? -1 : (long long)tile->root;
        cells->lost[i] = false;
    }
    for (std::size_t i = cells->count; i % kLanes > 0; ++i) { /* these are placed, too */
        for (int axis = 0; axis < 2; ++axis) cells->low[axis][i] = cells->high[axis][i] = 0;
        cells->curve[i] = -1;
    }
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
