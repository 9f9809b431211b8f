#include "compress/halvings/codes.h"

#include <acdf/halvings.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>

namespace acdf::compress {
namespace {

constexpr std::uint32_t kGuesses = 1u << 12;

} // namespace

// Between codes for p and q: a^2 / p + b^2 / (1 - p) is the same for both where (a / b)^2 is
// p q / ((1 - p) (1 - q)).
HalvingCodes::HalvingCodes(std::uint32_t bits)
    : bits_(bits), shares_(std::size_t{1} << bits),
      borders_(shares_.size(), std::numeric_limits<double>::infinity()), guesses_(kGuesses) {
    for (std::uint32_t code = 0; code < shares_.size(); ++code) shares_[code] = acdf_halving_share(code, bits);
    for (std::uint32_t code = 1; code + 1 < last(); ++code) {
        const double p = shares_[code] * 0x1p-31, q = shares_[code + 1] * 0x1p-31;
        const double ratio = std::sqrt(p * q / ((1.0 - p) * (1.0 - q)));
        borders_[code] = ratio / (1.0 + ratio);
    }
    std::uint32_t code = 1;
    for (std::uint32_t i = 0; i < kGuesses; ++i) {
        while (borders_[code] < i / double{kGuesses}) ++code;
        guesses_[i] = static_cast<std::uint16_t>(code);
    }
}

std::uint32_t HalvingCodes::lower(std::uint32_t wide, std::uint32_t code) const {
    const AcdfSpan steps = {{0, wide}};
    return wide > 0 ? acdf_halving_threshold(&steps, code, bits_, shares_[code]) : 0;
}

std::uint32_t HalvingCodes::nearest(double share) const {
    std::uint32_t code = guesses_[std::min(static_cast<std::uint32_t>(share * kGuesses), kGuesses - 1)];
    while (borders_[code] < share) ++code;
    return code;
}

double HalvingCodes::least(double least_a, double least_b) const {
    if (!(least_a > 0.0) || !(least_b > 0.0)) return least_a + least_b;
    const std::uint32_t middle = nearest(least_a / (least_a + least_b));
    double out = std::numeric_limits<double>::infinity();
    for (std::uint32_t code = std::max(middle, 2u) - 1; code <= std::min(middle + 1, last() - 1); ++code) {
        const double share = shares_[code] * 0x1p-31; // thresholds are rounded down
        out = std::min(out, std::max((least_a + 1.0) / share, least_b / (1.0 - share)));
    }
    return out;
}

std::uint32_t HalvingCodes::best(std::uint32_t wide, double a, double b, double least_a, double least_b) const {
    if (!(a > 0.0)) return 0;
    if (!(b > 0.0)) return last();
    std::uint32_t code = nearest(a / (a + b));
    while (code + 1 < last() && lower(wide, code) < least_a) ++code;
    while (code > 1 && wide - lower(wide, code) < least_b) --code;
    return code;
}

} // namespace acdf::compress
