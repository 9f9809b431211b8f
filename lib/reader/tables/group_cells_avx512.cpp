#if ACDF_WAVEFRONT_X86
#include "tables/group_cells_kernel.h"

void acdf::write_group_cells_avx512(const GroupCells& cells) noexcept { GroupCellsWriter(cells).write(); }
#endif
