// Which code of a halving stands for a share best.
#pragma once

#include <acdf/halvings.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace acdf::compress {

/// The shares that codes of so many bits stand for.
class HalvingCodes {
public:
    explicit HalvingCodes(std::uint32_t bits) : bits_(bits), shares_(std::size_t{1} << bits) {
        for (std::uint32_t code = 0; code < shares_.size(); ++code) shares_[code] = acdf_halving_share(code, bits);
    }

    /// Of `wide` steps of random numbers those that a code gives to the lower half.
    std::uint32_t lower(std::uint32_t wide, std::uint32_t code) const {
        const AcdfSpan steps = {{0, wide}};
        return wide > 0 ? acdf_halving_threshold(&steps, code, bits_, shares_[code]) : 0;
    }
    /// The code that makes a^2 / p + b^2 / (1 - p) smallest, of those that leave the halves so many steps; the
    /// first or the last where a or b is 0.
    std::uint32_t best(std::uint32_t wide, double a, double b, double least_a, double least_b) const {
        const std::uint32_t last = static_cast<std::uint32_t>(shares_.size()) - 1;
        if (!(a > 0.0)) return 0;
        if (!(b > 0.0)) return last;
        const auto loss = [&](std::uint32_t code) {
            const double p = lower(wide, code), q = wide - p;
            return a * (a / p) + b * (b / q);
        };
        const auto share = static_cast<std::uint32_t>(a / (a + b) * 0x1p31);
        const auto above = std::lower_bound(shares_.begin(), shares_.end(), share) - shares_.begin();
        std::uint32_t code = std::clamp(static_cast<std::uint32_t>(above), 1u, last - 1);
        if (code > 1 && loss(code - 1) < loss(code)) --code;
        while (code + 1 < last && lower(wide, code) < least_a) ++code;
        while (code > 1 && wide - lower(wide, code) < least_b) --code;
        return code;
    }

private:
    std::uint32_t bits_;
    std::vector<std::uint32_t> shares_;
};

} // namespace acdf::compress
