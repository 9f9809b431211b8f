// Normals or views of calls: each serves `each` calls that follow one another, and is looked up once for those of a
// block.
#pragma once

#include "batch/descents.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>

namespace acdf::batch {

// Numbers those of calls [first, first + count), at most a block, from the first of them on. Returns how many they
// are.
inline std::size_t number_conditions(std::size_t first, std::size_t count, std::size_t each, std::uint8_t* of) {
    std::size_t conditions = 0;
    for (std::size_t i = 0, number = first / each; i < count; ++number, ++conditions)
        for (const std::size_t end = std::min(count, (number + 1) * each - first); i < end; ++i)
            of[i] = static_cast<std::uint8_t>(conditions);
    return conditions;
}

// look_up(file, vector, point) finds a Point.
template <class File, class Point, auto look_up>
class Conditions {
public:
    Conditions(const File& file, const float* vectors, std::size_t each)
        : file_(file), vectors_(vectors), each_(each) {}

    // Looks up those of calls [first, first + count), at most a block.
    void take(std::size_t first, std::size_t count) {
        const std::size_t conditions = number_conditions(first, count, each_, of_);
        const float* vector = vectors_ + 3 * (first / each_);
        for (std::size_t k = 0; k < conditions; ++k) look_up(&file_, vector + 3 * k, &points_[k]);
    }
    const Point& operator[](std::size_t i) const { return points_[of_[i]]; }

    // Calls serve(i, point) for calls from `first` on, one after the other.
    template <class Serve>
    void one_by_one(std::size_t first, std::size_t count, Serve&& serve) {
        for (std::size_t at = first; at < count; at += kBlock) {
            const std::size_t n = std::min(kBlock, count - at);
            take(at, n);
            for (std::size_t i = 0; i < n; ++i) serve(at + i, (*this)[i]);
        }
    }

private:
    const File& file_;
    const float* vectors_;
    std::size_t each_;
    std::uint8_t of_[kBlock];
    Point points_[kBlock];
};

} // namespace acdf::batch
