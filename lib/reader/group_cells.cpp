#include "group_cells.h"

#include "group_cells_kernel.h"
#include "instructions.h"

#include <algorithm>

void acdf::write_group_cells(const GroupCells& cells, Instructions most) noexcept {
    most = std::min(most, instructions_of_this_processor());
#if ACDF_WAVEFRONT_X86
    if (most == Instructions::avx512) return write_group_cells_avx512(cells);
    if (most == Instructions::avx2) return write_group_cells_avx2(cells);
#endif
    GroupCellsWriter(cells).write();
}
