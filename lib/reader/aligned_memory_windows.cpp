// Blocks of the C library of Windows.
#if defined(_WIN32)

#include "aligned_memory.h"

#include <acdf/layout.h>

#include <malloc.h>

namespace acdf {

void* take_aligned(std::size_t bytes) noexcept { return _aligned_malloc(bytes, ACDF_ALIGNMENT); }

void give_aligned(void* block) noexcept { _aligned_free(block); }

} // namespace acdf

#endif
