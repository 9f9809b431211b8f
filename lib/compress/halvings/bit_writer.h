// Runs of bits in a chunk.
#pragma once

#include <cstdint>
#include <vector>

namespace acdf::compress {

/// Bits, the lowest of each byte first.
class BitWriter {
public:
    explicit BitWriter(std::vector<std::uint8_t>& bytes) : bytes_(bytes) {}

    void put(std::uint32_t value, std::uint32_t count) {
        held_ |= std::uint64_t{value} << used_;
        for (used_ += count; used_ >= 8; used_ -= 8, held_ >>= 8)
            bytes_.push_back(static_cast<std::uint8_t>(held_));
    }
    /// Zeros up to a multiple of 32 bits.
    void pad() {
        if (used_ > 0) put(0, 8 - used_);
        while (bytes_.size() % 4 != 0) bytes_.push_back(0);
    }

private:
    std::vector<std::uint8_t>& bytes_;
    std::uint64_t held_ = 0;
    std::uint32_t used_ = 0;
};

} // namespace acdf::compress
