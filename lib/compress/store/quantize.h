// Real probabilities to the integers that are stored.
#pragma once

#include <cstddef>
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

/// What rounding to a width does.
struct Rounding {
    double excess = 0.0;      ///< quantization_excess
    double worst_ratio = 1.0; ///< the largest factor by which a share falls below its probability
};

/// Rounds to the width of a code: 0, 1 or 2.
Rounding rounding_to(const std::vector<double>& probability, std::uint32_t code);

/// The code of the width that costs least: `price` a byte of each of `values`, and `reach` times the excess that
/// `rounding(code)` returns. `lit` probabilities are above 0, and each needs a share. Widths whose worst ratio is
/// above `most_ratio` are passed over while there is a wider one.
template <class RoundingOf>
std::uint32_t best_width(std::size_t values, std::uint64_t lit, double reach, double price, double most_ratio,
                         const RoundingOf& rounding) {
    constexpr std::uint64_t maximum[] = {0xFF, 0xFFFF, 0xFFFFFFFF};
    std::uint32_t best = 0;
    double least = std::numeric_limits<double>::infinity();
    for (std::uint32_t code = 0; code < 3; ++code) {
        if (lit > maximum[code]) continue;
        const double bytes = static_cast<double>(values) * static_cast<double>(1u << code);
        if (bytes * price >= least) break; // wider ones cost more even without any excess
        const Rounding rounded = rounding(code);
        const double cost = bytes * price + reach * rounded.excess;
        if (cost >= least || (code < 2 && rounded.worst_ratio > most_ratio)) continue;
        least = cost;
        best = code;
    }
    return best;
}

/// The best width, with 32 bits so that every share is at least 2^-24: a 24-bit random number reaches it.
QuantizedCurve quantize(const std::vector<double>& probability, double reach, double price,
                        double most_ratio = std::numeric_limits<double>::infinity());

} // namespace acdf::compress
