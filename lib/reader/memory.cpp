#include "memory.h"

#include <cstdint>
#include <cstdlib>

#if defined(_WIN32)
#include <malloc.h>
#elif defined(__linux__)
#include <sys/mman.h>
#endif

namespace acdf {
namespace {

#if defined(_WIN32)
void* take(std::size_t bytes) { return _aligned_malloc(bytes, ACDF_ALIGNMENT); }
void give(void* block) { _aligned_free(block); }
#else
// Asks for large pages where whole ones lie in a block: of a system that gives them only to those who ask, each
// page of 4 KiB costs a fault when it is first used, and draws look for places all over the tables.
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

void* take(std::size_t bytes) {
    void* const block = std::aligned_alloc(ACDF_ALIGNMENT, bytes);
    if (block) ask_for_large_pages(block, bytes);
    return block;
}
void give(void* block) { std::free(block); }
#endif

} // namespace

AcdfBlock take_block(const AcdfAllocator& allocator, std::size_t bytes) noexcept {
    AcdfBlock block;
    block.bytes = ((bytes ? bytes : 1) + ACDF_ALIGNMENT - 1) & ~std::size_t{ACDF_ALIGNMENT - 1};
    block.data =
        allocator.allocate ? allocator.allocate(allocator.context, block.bytes, ACDF_ALIGNMENT) : take(block.bytes);
    if (!block.data) block.bytes = 0;
    return block;
}

void give_block(const AcdfAllocator& allocator, AcdfBlock& block) noexcept {
    if (block.data && !allocator.allocate) give(block.data);
    else if (block.data && allocator.release) allocator.release(allocator.context, block.data, block.bytes);
    block = {};
}

} // namespace acdf
