// Numbers in any number of axes.
#pragma once

#include <cstdint>
#include <vector>

namespace acdf::build {

/// A table of numbers >= 0. Each is `values[i] * scale`. The scale is 1 unless a float64 lies outside what float32
/// holds in full precision; it is then the power of two that brings the largest number to about 2^127, and numbers
/// that are still too small become the smallest that float32 has, never 0.
struct Array {
    std::vector<std::uint32_t> shape;
    std::vector<float> values; ///< row-major; finite, >= 0
    double scale = 1.0;
};

} // namespace acdf::build
