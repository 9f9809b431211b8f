#include "tables/piece_cells.h"

#include "instructions.h"
#include "tables/piece_cells_kernel.h"

static bool write_pieces_plainly(const acdf::PieceCells& cells) noexcept { return PieceCellsWriter(cells).write(); }

bool acdf::write_piece_cells(const PieceCells& cells, Instructions most) noexcept {
    return ACDF_BEST_OF(most, write_pieces_plainly, write_piece_cells_avx2, write_piece_cells_avx512)(cells);
}
