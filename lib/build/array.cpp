#include "build/array.h"

#include <algorithm>
#include <cmath>

namespace acdf::build {
namespace {

constexpr double float_max = std::numeric_limits<float>::max();
constexpr double float_min = std::numeric_limits<float>::min();

bool is_bad(double value) { return !(value >= 0.0 && value <= std::numeric_limits<double>::max()); }

} // namespace

void Survey::add(double value, std::uint64_t index) {
    if (is_bad(value)) {
        ++(std::isnan(value) ? bad.nan : value < 0.0 && !std::isinf(value) ? bad.negative : bad.infinite);
        bad.first = std::min(bad.first, index);
    } else if (value > 0.0) {
        smallest = std::min(smallest, value);
        largest = std::max(largest, value);
    }
}

double Survey::factor() const {
    if (largest <= float_max && (largest == 0.0 || smallest >= float_min)) return 1.0;
    int exponent = 0;
    std::frexp(largest, &exponent);
    return std::ldexp(1.0, std::clamp(127 - exponent, -1000, 1000));
}

float scaled(double value, double factor) {
    if (is_bad(value) || value == 0.0) return 0.0f; // also -0
    value = std::max(value * factor, double{std::numeric_limits<float>::denorm_min()});
    return static_cast<float>(std::min(value, float_max));
}

std::string text(const BadValues& bad, const std::vector<std::uint32_t>& shape) {
    std::string kinds;
    const auto add = [&](std::uint64_t n, const char* kind) {
        if (n > 0) kinds += (kinds.empty() ? "" : ", ") + std::to_string(n) + " " + kind;
    };
    add(bad.nan, "NaN");
    add(bad.infinite, "infinite");
    add(bad.negative, "negative");
    return "it has numbers that a pdf cannot have: " + kinds + ", the first at [" + index_text(shape, bad.first) +
           "]";
}

std::string index_text(const std::vector<std::uint32_t>& shape, std::uint64_t flat) {
    std::string text;
    for (std::size_t axis = shape.size(); axis-- > 0; flat /= shape[axis])
        text = std::to_string(flat % shape[axis]) + (text.empty() ? "" : ", ") + text;
    return text;
}

} // namespace acdf::build
