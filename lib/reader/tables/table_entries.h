// Makes the runtime tables of acdf/table_entries.h.
#pragma once

#include "tables/tree_survey.h"

#include <acdf/allocator.h>
#include <acdf/table.h>

#include <cstddef>
#include <cstdint>

namespace acdf {

/// The tables of a table of so many bins (`survey`: of the tree, if it is done), in `block`, which the caller gives
/// back, of at most `most_bytes`; null where there can be none (tilts, trees that share curves too often, few
/// cells), and where memory fails.
AcdfEntries* make_table_entries(const AcdfTable& table, std::uint32_t bin_count, const TreeSurvey& survey,
                                std::size_t most_bytes, const AcdfAllocator& allocator, AcdfBlock& block) noexcept;

} // namespace acdf
