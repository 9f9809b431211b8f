#include "tables/scratch.h"

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <new>

namespace acdf {

namespace {

std::size_t scratch_lines(std::size_t bytes) {
    return (bytes + ACDF_ALIGNMENT - 1) & ~std::size_t{ACDF_ALIGNMENT - 1};
}

} // namespace

struct Scratch::Block {
    AcdfBlock memory;
    Block* before;
    std::size_t bytes; // from here on

    char* at(std::size_t used) { return reinterpret_cast<char*>(this) + used; }
};

// It begins with a large page; the bytes before it are never used.
bool Scratch::take(std::size_t bytes) noexcept {
    const std::size_t head = scratch_lines(sizeof(Block)), least = 3 * kLargePage;
    if (bytes > SIZE_MAX / 2) return false;
    const AcdfBlock memory = take_block({}, std::max(least, kLargePage + head + bytes));
    if (!memory.data) return false;
    const std::size_t before = (0 - reinterpret_cast<std::uintptr_t>(memory.data)) & (kLargePage - 1);
    block_ = new (static_cast<char*>(memory.data) + before) Block{memory, block_, memory.bytes - before};
    used_ = head;
    return true;
}

void* Scratch::grow(void* data, std::size_t used, std::size_t bytes, std::size_t more) noexcept {
    bytes = scratch_lines(bytes);
    more = scratch_lines(more);
    if (data && block_->at(used_) == static_cast<char*>(data) + bytes && more - bytes <= block_->bytes - used_) {
        used_ += more - bytes;
        return data;
    }
    if ((!block_ || more > block_->bytes - used_) && !take(more)) return nullptr;
    void* const moved = block_->at(used_);
    used_ += more;
    return used > 0 ? std::memcpy(moved, data, used) : moved;
}

void Scratch::clear() noexcept {
    while (block_) {
        AcdfBlock memory = block_->memory;
        block_ = block_->before;
        give_block({}, memory);
    }
    used_ = 0;
}

} // namespace acdf
