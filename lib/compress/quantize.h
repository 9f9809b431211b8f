// Real probabilities to the integers that are stored.
#pragma once

#include <cstdint>
#include <limits>
#include <vector>

namespace acdf::compress {

/// Cumulative integers of a curve: interior values only, out of 2^8 - 1, 2^16 - 1 or 2^32 - 1.
struct QuantizedCurve {
    std::uint32_t code = 0; ///< log2 of the bytes of a value: 0, 1 or 2
    std::vector<std::uint32_t> cumulative;
};

/// Rounds `probability` (>= 0, sum 1) to integers that sum to `maximum`: 0 stays 0, anything else gets at
/// least `smallest`, so that nothing with energy becomes unreachable. Largest remainders decide the rest.
/// Throws std::invalid_argument where the smallest shares alone exceed the maximum.
std::vector<std::uint64_t> apportion(const std::vector<double>& probability, std::uint64_t maximum,
                                     std::uint64_t smallest);

/// What sampling with shares q instead of p adds to E[(f/p)^2]: the sum of (p - q)^2 / q.
double quantization_excess(const std::vector<double>& probability, const std::vector<std::uint64_t>& shares);

/// The width that costs least: `price` a byte, and `reach` times its quantization_excess. With 32 bits every
/// share is at least 2^-24, so that a 24-bit random number reaches it.
///
/// Widths at which a share falls below its probability by more than a factor of `most_ratio` are passed over while
/// there is a wider one.
QuantizedCurve quantize(const std::vector<double>& probability, double reach, double price,
                        double most_ratio = std::numeric_limits<double>::infinity());

} // namespace acdf::compress
