// Real probabilities to the integers that are stored.
#pragma once

#include <cstdint>
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

/// Rounds to the width that costs least: `price` a byte of each value, and `reach` times the excess. With 32 bits
/// every share is at least 2^-24: a 24-bit random number reaches it.
QuantizedCurve quantize(const std::vector<double>& probability, double reach, double price);

} // namespace acdf::compress
