#include "memory.h"

#include <cstdlib>

#if defined(_WIN32)
#include <malloc.h>
#endif

namespace acdf {
namespace {

#if defined(_WIN32)
void* take(std::size_t bytes) { return _aligned_malloc(bytes, ACDF_ALIGNMENT); }
void give(void* block) { _aligned_free(block); }
#else
void* take(std::size_t bytes) { return std::aligned_alloc(ACDF_ALIGNMENT, bytes); }
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
