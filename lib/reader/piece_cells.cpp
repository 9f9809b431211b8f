#include "piece_cells.h"

#include "instructions.h"
#include "piece_cells_kernel.h"

#include <algorithm>

bool acdf::write_piece_cells(const PieceCells& cells, Instructions most) noexcept {
    most = std::min(most, instructions_of_this_processor());
#if ACDF_WAVEFRONT_X86
    if (most == Instructions::avx512) return write_piece_cells_avx512(cells);
    if (most == Instructions::avx2) return write_piece_cells_avx2(cells);
#endif
    return PieceCellsWriter(cells).write();
}
