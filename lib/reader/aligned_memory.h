// Blocks of the C library, aligned to ACDF_ALIGNMENT.
#pragma once

#include <cstddef>

namespace acdf {

/// `bytes`, a multiple of ACDF_ALIGNMENT; null where there are none.
void* take_aligned(std::size_t bytes) noexcept;

void give_aligned(void* block) noexcept;

} // namespace acdf
