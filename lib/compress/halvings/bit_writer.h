// Runs of bits in a chunk.
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <vector>

namespace acdf::compress {

/// Bits, the lowest of each byte first, in words of 32 behind what `bytes` holds.
class BitWriter {
public:
    explicit BitWriter(std::vector<std::uint8_t>& bytes) : bytes_(bytes) {}

    void put(std::uint32_t value, std::uint32_t count) {
        held_ |= std::uint64_t{value} << used_;
        used_ += count;
        if (used_ >= 32) flush();
    }
    /// Zeros up to a whole word.
    void pad() {
        if (used_ > 0) flush();
        used_ = 0;
    }

private:
    void flush() {
        const auto word = static_cast<std::uint32_t>(held_);
        const std::size_t at = bytes_.size();
        bytes_.resize(at + sizeof word);
        std::memcpy(bytes_.data() + at, &word, sizeof word); // of a little-endian machine, which CMake checks
        held_ >>= 32;
        used_ = used_ > 32 ? used_ - 32 : 0;
    }

    std::vector<std::uint8_t>& bytes_;
    std::uint64_t held_ = 0;
    std::uint32_t used_ = 0;
};

} // namespace acdf::compress
