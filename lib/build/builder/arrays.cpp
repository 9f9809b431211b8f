#include "build/builder/arrays.h"

#include "build/builder/guard.h"
#include "build/builder/strides.h"

#include <stdexcept>

namespace acdf::builder {
namespace {

constexpr std::size_t max_axes = 6;

std::vector<StridedAxis> axes_of(const Array& array) {
    std::vector<StridedAxis> axes;
    for (const std::uint32_t length : array.shape) axes.push_back({length, 0});
    auto packed = static_cast<std::ptrdiff_t>(size_of(array.number));
    for (std::size_t i = axes.size(); i-- > 0;) {
        axes[i].stride = array.strides.empty() ? packed : array.strides[i];
        packed *= static_cast<std::ptrdiff_t>(axes[i].length);
    }
    return axes;
}

/// Calls visit(row-major index, number) for each.
template <class Visit>
void for_each(const Array& array, const Visit& visit) {
    const std::vector<StridedAxis> axes = axes_of(array);
    std::vector<std::uint64_t> at(axes.size(), 0);
    const auto* number = static_cast<const unsigned char*>(array.data);
    for (std::uint64_t i = 0;; ++i) {
        visit(i, number_at(array.number, number));
        std::size_t axis = axes.size();
        for (;;) {
            if (axis-- == 0) return;
            number += axes[axis].stride;
            if (++at[axis] < axes[axis].length) break;
            number -= axes[axis].stride * static_cast<std::ptrdiff_t>(axes[axis].length);
            at[axis] = 0;
        }
    }
}

} // namespace

void check(const Array& array) {
    require(array.data != nullptr, "the array's data is null");
    require(size_of(array.number) > 0, "the array's number is not a Number");
    require(!array.shape.empty() && array.shape.size() <= max_axes, "an array has 1 to 6 axes");
    std::uint64_t count = 1;
    for (const std::uint32_t length : array.shape) {
        require(length > 0, "an axis of the array has length 0");
        count *= length;
        require(count <= std::uint64_t{1} << 40, "an array has more than 2^40 numbers");
    }
    require(array.strides.empty() || array.strides.size() == array.shape.size(),
            "an array has one stride an axis, or none");
    std::vector<StridedAxis> axes = axes_of(array);
    check_strides(axes.data(), axes.size(), size_of(array.number));
}

build::Array to_floats(const Array& array, BadNumbers& bad) {
    build::Survey found;
    for_each(array, [&](std::uint64_t i, double value) { found.add(value, i); });
    bad = found.bad;
    build::Array out;
    out.shape = array.shape;
    const double factor = array.number == Number::float64 ? found.factor() : 1.0;
    out.scale = 1.0 / factor;
    std::size_t count = 1;
    for (const std::uint32_t length : array.shape) count *= length;
    out.values.resize(count);
    for_each(array, [&](std::uint64_t i, double value) { out.values[i] = build::scaled(value, factor); });
    return out;
}

} // namespace acdf::builder
