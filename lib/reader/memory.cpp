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
void* take_aligned(std::size_t bytes) { return _aligned_malloc(bytes, ACDF_ALIGNMENT); }
void give_aligned(void* block) { _aligned_free(block); }
#else
void* take_aligned(std::size_t bytes) {
    void* const block = std::aligned_alloc(ACDF_ALIGNMENT, bytes);
#if defined(MADV_HUGEPAGE)
    // Large pages where whole ones lie in the block: each page of 4 KiB costs a fault when it is first used, and
    // samples read all over the tables. Some systems give large ones only to those who ask.
    constexpr std::uintptr_t page = std::uintptr_t{1} << 21;
    const auto begin = reinterpret_cast<std::uintptr_t>(block);
    const std::uintptr_t first = (begin + page - 1) & ~(page - 1), last = (begin + bytes) & ~(page - 1);
    if (block && first < last) madvise(reinterpret_cast<void*>(first), last - first, MADV_HUGEPAGE);
#endif
    return block;
}
void give_aligned(void* block) { std::free(block); }
#endif

} // namespace

AcdfBlock take_block(const AcdfAllocator& allocator, std::size_t bytes) noexcept {
    AcdfBlock block;
    block.bytes = ((bytes ? bytes : 1) + ACDF_ALIGNMENT - 1) & ~std::size_t{ACDF_ALIGNMENT - 1};
    block.data = allocator.allocate ? allocator.allocate(allocator.context, block.bytes, ACDF_ALIGNMENT)
                                    : take_aligned(block.bytes);
    if (!block.data) block.bytes = 0;
    return block;
}

void give_block(const AcdfAllocator& allocator, AcdfBlock& block) noexcept {
    if (block.data && !allocator.allocate) give_aligned(block.data);
    else if (block.data && allocator.release) allocator.release(allocator.context, block.data, block.bytes);
    block = {};
}

} // namespace acdf
