// Makes the lookup grids of a table, once, when a file is opened. Not installed.
#pragma once

#include "sources.h"

#include <acdf/allocator.h>
#include <acdf/table.h>

#include <cstddef>

namespace acdf {

/// Points a table to the lookup grids of its bins and to its `count` nodes, copied behind them, in `block`, which
/// the caller gives back. Leaves it as it is, and `block` empty, where grids would take more than `most_bytes` or
/// there is no memory. Linear in the nodes and the squares of the grids.
void make_table_lookup(AcdfTable& table, u32 bins, u32 count, std::size_t most_bytes,
                       const AcdfAllocator& allocator, AcdfBlock& block) noexcept;

} // namespace acdf
