// Memory for arrays that are needed only while tables are made.
#pragma once

#include "memory.h"

#include <cstddef>

namespace acdf {

/// Takes blocks in which large pages lie, uses these first, and gives all of them back at once: each page of 4 KiB
/// that is asked of the system costs a fault, which takes longer than what is done with it.
class Scratch {
public:
    Scratch() noexcept = default;
    Scratch(const Scratch&) = delete;
    Scratch& operator=(const Scratch&) = delete;
    ~Scratch() { clear(); }

    /// Moves `used` bytes of an array at `data` (null: none) with room for `bytes` to where there is room for
    /// `more`: in place, if it is the newest one and its block is long enough. Null where memory fails.
    void* grow(void* data, std::size_t used, std::size_t bytes, std::size_t more) noexcept;

    /// Gives back all.
    void clear() noexcept;

private:
    struct Block;
    bool take(std::size_t bytes) noexcept;

    Block* block_ = nullptr; ///< the newest one
    std::size_t used_ = 0;   ///< of its bytes
};

} // namespace acdf
