// Runs of bits in a chunk. Not installed.
#pragma once

#include "check/checker.h"

namespace acdf {

/// Bits of whole words, the lowest of each byte first.
class Bits {
public:
    Bits(const Payload& payload, u64 begin, u64 end) : payload_(&payload), at_(begin * 8), end_(end * 8) {}

    bool has(u64 count) const { return end_ - at_ >= count; }
    /// Fewer than 32, which are there.
    u32 take(u32 count) {
        const u64 word = at_ / 32;
        u64 held = load_u32(payload_->data + 4 * word);
        if (at_ % 32 + count > 32) held |= u64{load_u32(payload_->data + 4 * word + 4)} << 32;
        const auto value = static_cast<u32>(held >> at_ % 32) & ((u32{1} << count) - 1);
        at_ += count;
        return value;
    }
    u64 place() const { return payload_->at(at_ / 8); }

private:
    const Payload* payload_;
    u64 at_, end_;
};

inline u64 words_for(u64 bits) { return (bits + 31) / 32; }

} // namespace acdf
