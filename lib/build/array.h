// Numbers in any number of axes, and how they become floats.
#pragma once

#include <acdf/builder.h>

#include <cstdint>
#include <limits>
#include <string>
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

/// Numbers that are no pdf: `first` is the index of the first one in row-major order.
using BadValues = builder::BadNumbers;

/// What numbers are, before they become floats.
struct Survey {
    BadValues bad;
    double smallest = std::numeric_limits<double>::infinity(), largest = 0.0; ///< of the positive ones

    /// `index`: row-major.
    void add(double value, std::uint64_t index);
    /// The power of two by which numbers are multiplied before they become floats.
    double factor() const;
};

/// A number as a float: bad ones and 0 as 0, others times `factor` and never 0.
float scaled(double value, double factor);

/// "it has numbers that are no pdf: 2 NaN, 1 negative, the first at [3, 0, 12]".
std::string text(const BadValues& bad, const std::vector<std::uint32_t>& shape);

/// "3, 0, 12": where the `flat`-th number in row-major order stands.
std::string index_text(const std::vector<std::uint32_t>& shape, std::uint64_t flat);

} // namespace acdf::build
