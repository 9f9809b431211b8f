// Blocks of the C library where it is POSIX's.
#if !defined(_WIN32)

#include "aligned_memory.h"

#include "memory.h"

#include <cstdint>
#include <cstdlib>

#if defined(__linux__)
#include <sys/mman.h>
#endif

namespace acdf {

namespace {

// Asks for large pages where whole ones lie in a block: of a system that gives them only to those who ask, each
// page of 4 KiB costs a fault when it is first used, and samples read all over the tables.
void ask_for_large_pages(void* block, std::size_t bytes) {
#if defined(MADV_HUGEPAGE)
    const std::uintptr_t begin = reinterpret_cast<std::uintptr_t>(block);
    const std::uintptr_t first = (begin + kLargePage - 1) & ~(kLargePage - 1),
                         last = (begin + bytes) & ~(kLargePage - 1);
    if (first < last) madvise(reinterpret_cast<void*>(first), last - first, MADV_HUGEPAGE); // it may say no
#else
    static_cast<void>(block), static_cast<void>(bytes);
#endif
}

} // namespace

void* take_aligned(std::size_t bytes) noexcept {
    void* const block = std::aligned_alloc(ACDF_ALIGNMENT, bytes);
    if (block) ask_for_large_pages(block, bytes);
    return block;
}

void give_aligned(void* block) noexcept { std::free(block); }

} // namespace acdf

#endif
