#include "compress/tables/box_sums.h"

#include "compress/widths.h"

#include <algorithm>

namespace acdf::compress {
namespace {

constexpr std::size_t kSumLanes = 8; // additions that do not wait for each other

ACDF_WIDTHS double sum_of_many(const float* values, std::size_t count, bool squared) {
    double lane[kSumLanes] = {}, sum = 0.0;
    std::size_t i = 0;
    if (squared) {
        for (; i + kSumLanes <= count; i += kSumLanes)
            for (std::size_t k = 0; k < kSumLanes; ++k) {
                const double value = static_cast<double>(values[i + k]);
                lane[k] += value * value;
            }
        for (; i < count; ++i) sum += static_cast<double>(values[i]) * static_cast<double>(values[i]);
    } else {
        for (; i + kSumLanes <= count; i += kSumLanes)
            for (std::size_t k = 0; k < kSumLanes; ++k) lane[k] += static_cast<double>(values[i + k]);
        for (; i < count; ++i) sum += static_cast<double>(values[i]);
    }
    for (const double of_lane : lane) sum += of_lane;
    return sum;
}

/// The same, bit for bit, without a call where there are few.
double sum_of(const float* values, std::size_t count, bool squared) {
    if (count >= kSumLanes) return sum_of_many(values, count, squared);
    double sum = 0.0;
    for (std::size_t i = 0; i < count; ++i) {
        const double value = static_cast<double>(values[i]);
        sum += squared ? value * value : value;
    }
    return sum;
}

/// Where the quarters of a box end on an axis.
struct Quarters {
    std::uint32_t end[5] = {};

    Quarters() = default;
    explicit Quarters(const TableBox::Span& span) {
        const std::uint32_t middle = span.middle();
        const TableBox::Span lower{span.low, middle}, upper{middle, span.high};
        end[0] = span.low;
        end[1] = lower.middle();
        end[2] = middle;
        end[3] = upper.middle();
        end[4] = span.high;
    }
    std::uint32_t of(std::uint32_t step) const { return step < end[2] ? step >= end[1] : 2u + (step >= end[3]); }
};

/// Calls visit(line) for each line of the last axis: where its first step lies among the numbers. `moved(axis,
/// step)` goes before, for each other axis whose step is another one than that of the line before.
template <class Moved, class Visit>
void for_each_line(const TableNumbers& numbers, const TableBox& box, const Moved& moved, const Visit& visit) {
    const std::size_t last = numbers.shape.size() - 1;
    std::array<std::uint32_t, ACDF_MAX_AXES> step{};
    for (std::size_t axis = 0; axis < last; ++axis) moved(axis, step[axis] = box.axis[axis].low);
    while (true) {
        std::size_t at = 0;
        for (std::size_t axis = 0; axis < last; ++axis) at = (at + step[axis]) * numbers.shape[axis + 1];
        visit(at + box.axis[last].low);
        std::size_t axis = last;
        while (axis-- > 0) {
            const bool more = ++step[axis] < box.axis[axis].high;
            if (!more) step[axis] = box.axis[axis].low;
            moved(axis, step[axis]);
            if (more) break;
        }
        if (axis >= last) return; // all are at their first step again
    }
}

} // namespace

TableBox half(TableBox box, std::size_t axis, std::uint32_t upper) {
    TableBox::Span& span = box.axis[axis];
    (upper ? span.low : span.high) = span.middle();
    return box;
}

void sum_box(const TableNumbers& numbers, const TableBox& box, BoxSums& out) {
    const std::size_t axes = numbers.shape.size(), last = axes - 1;
    out = {};
    std::array<Quarters, ACDF_MAX_AXES> quarters;
    for (std::size_t axis = 0; axis < axes; ++axis) quarters[axis] = Quarters(box.axis[axis]);
    std::array<std::uint32_t, ACDF_MAX_AXES> quarter{};
    const std::uint32_t* ends = quarters[last].end;
    for_each_line(
        numbers, box, [&](std::size_t axis, std::uint32_t step) { quarter[axis] = quarters[axis].of(step); },
        [&](std::size_t at) {
            double part[4], halves[2];
            const float* line = numbers.values + at;
            for (std::size_t k = 0; k < 4; ++k) {
                part[k] = sum_of(line + (ends[k] - ends[0]), ends[k + 1] - ends[k], numbers.squared);
                out.quarter[last][k] += part[k];
            }
            for (std::size_t k = 0; k < 2; ++k) halves[k] = part[2 * k] + part[2 * k + 1];
            const double whole = halves[0] + halves[1];
            out.all += whole;
            for (std::size_t a = 0; a < last; ++a) {
                const std::uint32_t upper = quarter[a] / 2;
                out.quarter[a][quarter[a]] += whole;
                for (std::size_t b = a + 1; b < last; ++b) out.pair[a][b][2 * upper + quarter[b] / 2] += whole;
                for (std::size_t k = 0; k < 2; ++k) out.pair[a][last][2 * upper + k] += halves[k];
            }
        });
}

double sum_in(const TableNumbers& numbers, const TableBox& box) {
    const std::size_t length = box.axis[numbers.shape.size() - 1].length();
    double sum = 0.0;
    for_each_line(
        numbers, box, [](std::size_t, std::uint32_t) {},
        [&](std::size_t at) { sum += sum_of(numbers.values + at, length, numbers.squared); });
    return sum;
}

float largest_in(const TableNumbers& numbers, const TableBox& box) {
    const std::size_t length = box.axis[numbers.shape.size() - 1].length();
    float largest = 0.0f;
    for_each_line(
        numbers, box, [](std::size_t, std::uint32_t) {},
        [&](std::size_t at) {
            largest = std::max(largest, *std::max_element(numbers.values + at, numbers.values + at + length));
        });
    return largest;
}

} // namespace acdf::compress
