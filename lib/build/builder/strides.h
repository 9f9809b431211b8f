// Numbers that a caller holds somewhere in memory.
#pragma once

#include <acdf/builder.h>

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <vector>

namespace acdf::builder {

/// Bytes of a number; 0 for what is none.
std::size_t size_of(Number number);

/// IEEE 754 binary16.
float half_to_float(std::uint16_t half);

/// The number at any address.
inline double number_at(Number number, const unsigned char* at) {
    if (number == Number::float32) {
        float value;
        std::memcpy(&value, at, sizeof value);
        return static_cast<double>(value);
    }
    if (number == Number::float16) {
        std::uint16_t value;
        std::memcpy(&value, at, sizeof value);
        return static_cast<double>(half_to_float(value));
    }
    double value;
    std::memcpy(&value, at, sizeof value);
    return value;
}

/// An axis of an array: how many, and how far apart in bytes.
struct StridedAxis {
    std::uint64_t length = 1;
    std::ptrdiff_t stride = 0;
};

/// Throws build::OptionError where numbers would overlap, or addresses leave what a pointer can reach.
void check_strides(std::vector<StridedAxis> axes, std::size_t item);

} // namespace acdf::builder
