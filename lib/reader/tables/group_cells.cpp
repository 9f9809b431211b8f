#include "tables/group_cells.h"

#include "instructions.h"
#include "tables/group_cells_kernel.h"

#include <algorithm>

static void write_groups_plainly(const acdf::GroupCells& cells) noexcept { GroupCellsWriter(cells).write(); }

void acdf::write_group_cells(const GroupCells& cells, Instructions most, const AcdfParallel& parallel) noexcept {
    constexpr std::size_t together = 256; // groups
    const auto write = ACDF_BEST_OF(most, write_groups_plainly, write_group_cells_avx2, write_group_cells_avx512);
    in_parallel(parallel, (cells.count + together - 1) / together,
                [&](std::size_t i) { write(cells.part(i * together, std::min((i + 1) * together, cells.count))); });
}
