#if ACDF_WAVEFRONT_X86
#include "tables/piece_cells_kernel.h"

bool acdf::write_piece_cells_avx2(const PieceCells& cells) noexcept { return PieceCellsWriter(cells).write(); }
#endif
