#include "tables/group_cells.h"

#include "instructions.h"
#include "tables/group_cells_kernel.h"

static void write_groups_plainly(const acdf::GroupCells& cells) noexcept { GroupCellsWriter(cells).write(); }

void acdf::write_group_cells(const GroupCells& cells, Instructions most) noexcept {
    ACDF_BEST_OF(most, write_groups_plainly, write_group_cells_avx2, write_group_cells_avx512)(cells);
}
