// Runs of bits in a chunk. Not installed.
#pragma once

#include "check/checker.h"

namespace acdf {

/// Bits of whole words, the lowest of each byte first.
class Bits {
public:
    Bits(const Payload& payload, std::uint64_t begin, std::uint64_t end)
        : payload_(&payload), at_(begin * 8), end_(end * 8) {}

    bool has(std::uint64_t count) const { return end_ - at_ >= count; }
    /// Fewer than 32, which are there.
    std::uint32_t take(std::uint32_t count) {
        const std::uint64_t word = at_ / 32;
        std::uint64_t held = load_u32(payload_->data + 4 * word);
        if (at_ % 32 + count > 32) held |= std::uint64_t{load_u32(payload_->data + 4 * word + 4)} << 32;
        const auto value = static_cast<std::uint32_t>(held >> at_ % 32) & ((std::uint32_t{1} << count) - 1);
        at_ += count;
        return value;
    }
    std::uint64_t place() const { return payload_->at(at_ / 8); }

private:
    const Payload* payload_;
    std::uint64_t at_, end_;
};

inline std::uint64_t words_for(std::uint64_t bits) { return (bits + 31) / 32; }

} // namespace acdf
