// Makes the runtime tables of acdf/local_tables.h.
#pragma once

#include <acdf/allocator.h>
#include <acdf/local.h>

#include <cstddef>
#include <cstdint>

namespace acdf {

/// The tables of a local environment whose bins share tiles and whose tree takes `tree_units`,
/// in `block`, which the caller gives back, of at most `most_bytes`; pieces only where a cache holds them;
/// null where they would take more, and where memory fails. The work is linear in the file.
AcdfLocalTables* make_local_tables(const AcdfLocal& local, std::uint32_t tree_units, std::size_t most_bytes,
                                   const AcdfAllocator& allocator, AcdfBlock& block) noexcept;

} // namespace acdf
