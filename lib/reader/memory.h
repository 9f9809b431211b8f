// Memory that outlives a call: of the caller's allocator, or of the C library.
#pragma once

#include <acdf/allocator.h>
#include <acdf/layout.h>

#include <cstddef>

namespace acdf {

/// At least `bytes`, aligned to ACDF_ALIGNMENT; data is null where there are none.
AcdfBlock take_block(const AcdfAllocator& allocator, std::size_t bytes) noexcept;

/// Gives back what take_block took from the same allocator, if anything, and
/// leaves `block` empty.
void give_block(const AcdfAllocator& allocator, AcdfBlock& block) noexcept;

} // namespace acdf
