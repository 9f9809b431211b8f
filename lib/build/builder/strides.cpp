#include "build/builder/strides.h"

#include "build/builder/guard.h"

#include <algorithm>
#include <limits>

namespace acdf::builder {

std::size_t size_of(Number number) {
    switch (number) {
    case Number::float32:
        return 4;
    case Number::float16:
        return 2;
    case Number::float64:
        return 8;
    }
    return 0;
}

void check_strides(StridedAxis* axes, std::size_t count, std::size_t item) {
    constexpr std::uint64_t reach = std::numeric_limits<std::ptrdiff_t>::max();
    const auto step = [](const StridedAxis& axis) {
        const auto stride = static_cast<std::uint64_t>(axis.stride);
        return axis.stride < 0 ? ~stride + 1 : stride;
    };
    std::sort(axes, axes + count, [&](const StridedAxis& a, const StridedAxis& b) { return step(a) < step(b); });
    // From the finest on, a step must leave all behind that the finer axes span.
    std::uint64_t span = item;
    for (const StridedAxis* at = axes; at != axes + count; ++at) {
        const StridedAxis& axis = *at;
        if (axis.length == 1) continue;
        require(step(axis) >= span, "the strides are too short: numbers overlap");
        require(step(axis) <= (reach - span) / (axis.length - 1), "the strides reach farther than memory does");
        span += step(axis) * (axis.length - 1);
    }
}

} // namespace acdf::builder
