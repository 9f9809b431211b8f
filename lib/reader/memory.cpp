#include "memory.h"

#include "aligned_memory.h"

namespace acdf {

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
