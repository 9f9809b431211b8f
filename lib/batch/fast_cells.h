// Lanes in tiles and cells of the fast shape: the second half of acdf/fast.h and acdf_local_fast_cell_pdf over
// vectors. Internal linkage: see local_kernel.h.
#pragma once

#include "batch/fast_vectors.h"

#include <cstddef>
#include <cstring>

namespace {

/// Cells of lanes, and how they are reached; of, all: AcdfFastShare of tiles.
struct FastCells {
    alignas(64) double u[2][kRoom], of[kRoom], all[kRoom];
    alignas(64) std::int32_t index[2][kRoom]; // of the cell in its line, and of that
    const AcdfTileRecord* tile[kRoom];
    const std::uint8_t* list[kRoom]; // of the tile's lines; samples go on to that of a line
};

/* The grid of a lane's tile. */
ACDF_LANE void enter_tile(const AcdfLocal& local, std::uint32_t tile, std::size_t i, FastCells* c) {
    c->tile[i] = acdf_local_tile(local.tables, tile);
    c->list[i] = local.fast.grid + c->tile[i]->root + 2;
    ACDF_PREFETCH(c->list[i]);
}

/* Cumulative values around a number in a list. Of the first one what stands before is no such value. */
ACDF_LANE std::int32_t ends_at(const std::uint8_t* list, std::uint32_t number) {
    std::uint16_t both;
    std::memcpy(&both, list + (std::ptrdiff_t)number - 1, 2);
    return both;
}

/* The list of a line's cells. */
ACDF_LANE const std::uint8_t* line_of(const FastCells& c, std::size_t i, std::uint32_t line) {
    return c.list[i] + (c.tile[i]->step[3] + line * c.tile[i]->step[2]);
}

/* Cumulative values before and at some numbers, of both as they lie. */
ACDF_LANE void split_ends(Ints both, Ints number, Ints* before, Ints* end) {
    *before = both & 0xFF & (number > 0);
    *end = both >> 8;
}

/// Boxes of a vector of tiles or cells.
struct FastBoxes {
    Ints low[2], high[2];
};

/* The boxes of tiles, and the shifts of their grids. */
ACDF_LANE FastBoxes boxes_of(const AcdfTileRecord* const* tile, Ints shift[2]) {
    static_assert(offsetof(AcdfTileRecord, low) == 0 && offsetof(AcdfTileRecord, high) == 8);
    Ints side[4];
    gather_fours(tile, side);
    const Ints steps = words_at(tile, offsetof(AcdfTileRecord, step));
    shift[0] = steps & 0xFFFF;
    shift[1] = (steps >> 16) & 0xFFFF;
    return {{side[0], side[1]}, {side[2], side[3]}};
}

/* acdf_fast_narrow */
ACDF_LANE FastBoxes narrowed(const FastCells& c, std::size_t at) {
    Ints shift[2];
    FastBoxes box = boxes_of(c.tile + at, shift);
    for (int axis = 0; axis < 2; ++axis) {
        const Ints size = (Ints{} + 1) << shift[axis];
        box.low[axis] += loaded(&c.index[axis][at]) << shift[axis];
        box.high[axis] = box.low[axis] + least(box.high[axis] - box.low[axis], size);
    }
    return box;
}

/* What acdf_grid_height says of cells; on the lat-long grid z becomes what it is at their borders. */
ACDF_LANE Vector heights_of(const AcdfLocal& local, const FastBoxes& box, Vector z[2]) {
    const double* const heights = acdf_local_heights(local.tables);
    if (local.tables->octahedral)
        return 2.0 * to_doubles(box.high[1] - box.low[1]) / (double)local.environment.rows;
    z[0] = (Vector)gathered<8>(heights, to_indices(box.low[1]));
    z[1] = (Vector)gathered<8>(heights, to_indices(box.high[1]));
    return z[0] - z[1];
}

/* acdf_local_fast_cell_pdf of a vector of cells of such heights; ends: as ends_at returns them on each axis. */
ACDF_LANE Vector fast_cell_pdf(const AcdfLocal& local, const FastCells& c, const Ints ends[2], const FastBoxes& box,
                               Vector height, std::size_t at) {
    Ints before[2], end[2];
    for (int axis = 0; axis < 2; ++axis)
        split_ends(ends[axis], loaded(&c.index[axis][at]), &before[axis], &end[axis]);
    const Vector of = loaded(&c.of[at]) * to_doubles((end[0] - before[0]) * (end[1] - before[1]));
    const Vector width = to_doubles(box.high[0] - box.low[0]);
    const Vector pdf =
        of * (double)local.environment.columns / (2.0 * ACDF_PI * width * (loaded(&c.all[at]) * height));
    const Vector least = select(of > 0.0, all(1.17549435e-38), all(0.0));
    return select(pdf >= 3.402823466e38, all((double)3.402823466e38f), select(pdf > least, pdf, least));
}

} // namespace
