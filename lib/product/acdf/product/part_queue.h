// Which part of a cut to divide next (acdf/product/product.h). C++17, header only, freestanding.
#pragma once

#include <acdf/method.h>
#include <acdf/product/cut.h>

#include <cstdint>

namespace acdf {

/// Parts in order of what is to be gained by dividing them, to an octave of its square.
class PartQueue {
public:
    /// Squares of priorities are distinguished from 2^-57 `scale` to 64 `scale`.
    ACDF_METHOD explicit PartQueue(double scale) noexcept : top_(key(64.0 * scale)), filled_(0) {
        memset(head_, -1, sizeof head_);
    }

    ACDF_METHOD void push(int part, double square) noexcept {
        const int below = top_ - key(square), bucket = below < 0 ? 0 : below > 63 ? 63 : below;
        next_[part] = head_[bucket];
        head_[bucket] = static_cast<std::int8_t>(part);
        filled_ |= std::uint64_t{1} << bucket;
    }
    /// -1 where there is none.
    ACDF_METHOD int pop() noexcept {
        if (filled_ == 0) return -1;
        const auto low = static_cast<std::uint32_t>(filled_);
        const std::uint32_t bucket =
            low ? acdf_lowest_bit(low) : 32 + acdf_lowest_bit(static_cast<std::uint32_t>(filled_ >> 32));
        const int part = head_[bucket];
        head_[bucket] = next_[part];
        filled_ &= ~(static_cast<std::uint64_t>(head_[bucket] < 0) << bucket);
        return part;
    }

private:
    ACDF_METHOD static int key(double x) noexcept { // the binary logarithm, rounded down
        std::uint64_t bits;
        memcpy(&bits, &x, sizeof bits);
        return static_cast<int>(bits >> 52);
    }

    int top_;
    std::uint64_t filled_;
    std::int8_t head_[64], next_[ACDF_CUT_MAX_PARTS];
};

} // namespace acdf
