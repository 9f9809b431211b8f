// Numbers that a caller holds somewhere in memory.
#pragma once

#include <acdf/builder.h>

#include <cstddef>
#include <cstdint>
#include <cstring>

namespace acdf::builder {

/// Bytes of a number; 0 for what is none.
std::size_t size_of(Number number);

/// IEEE 754 binary16. Without branches, so that compilers make vectors of it.
inline float half_to_float(std::uint16_t half) {
    const std::uint32_t bits = (half & 0x7FFFu) << 13, sign = (half & 0x8000u) << 16;
    float small; // its exponent is 112 too low, also where it is denormal
    std::memcpy(&small, &bits, sizeof small);
    small *= 0x1p112f;
    std::uint32_t value;
    std::memcpy(&value, &small, sizeof value);
    value = ((half & 0x7C00u) == 0x7C00u ? bits | 0x7F800000u : value) | sign;
    float out;
    std::memcpy(&out, &value, sizeof out);
    return out;
}

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
void check_strides(StridedAxis* axes, std::size_t count, std::size_t item); ///< sorts the axes

} // namespace acdf::builder
