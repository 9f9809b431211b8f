// Makes the runtime tables of acdf/groups.h.
#pragma once

#include <acdf/allocator.h>
#include <acdf/sample.h>

#include <cstddef>
#include <cstdint>

namespace acdf {

/// The tables of an environment whose tree takes `tree_units`, in `block`, which the caller gives back, of at most
/// `most_bytes`; null where there are none: for trees with tilts, of one cell or with more cells than units, for
/// grids of 2^31 steps and more, where they would take more bytes, and where memory fails. The work is linear in
/// tree_units.
AcdfGroups* make_groups(const AcdfEnvironment& environment, std::uint32_t tree_units, std::size_t most_bytes,
                        const AcdfAllocator& allocator, AcdfBlock& block) noexcept;

} // namespace acdf
