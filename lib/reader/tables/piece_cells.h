// Writes what tables of cells say of each piece (acdf/cells.h), of sixteen cells of a tree at a time.
#pragma once

#include "tables/sides.h"
#include "tables/squares.h"

#include <acdf/cells.h>
#include <acdf/sample.h>
#include <acdf/wavefront.h>

#include <cstddef>
#include <cstdint>

namespace acdf {

/// Where pieces are written that follow each other: room for sixteen.
struct PieceRows {
    AcdfPiece* pieces;
    float* densities;
    KeySpan *numbers[2], *keys[2]; ///< of each axis
};

/// Takes pieces in the order of their cells: `maker` is what the functions are called with.
struct PieceSink {
    void* maker;
    /// False where there is no room: nothing else is asked for then.
    bool (*room)(void* maker, PieceRows& rows) noexcept;
    /// As many were written there.
    void (*keep)(void* maker, std::size_t count) noexcept;
    /// The pieces of a cell that may lie in several; false as of `room`.
    bool (*add_cut)(void* maker, const Cell& cell) noexcept;
};

/// What is the same for all cells.
struct PieceCells {
    const AcdfEnvironment& environment; ///< less than 2^31 columns and rows; no tilts
    const double* tangents;             ///< of each border between columns; not on the square
    const Sides::Row* rows;             ///< of each border between rows; not on the square
    PieceSink sink;
};

/// Of all cells of the tree, by the best instructions that the processor has, up to `most`: the same bits by any.
/// False where the sink had no room.
bool write_piece_cells(const PieceCells& cells, Instructions most) noexcept;
#if ACDF_WAVEFRONT_X86
bool write_piece_cells_avx2(const PieceCells& cells) noexcept;
bool write_piece_cells_avx512(const PieceCells& cells) noexcept;
#endif

} // namespace acdf
