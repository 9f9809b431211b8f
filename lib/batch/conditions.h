// Normals or views of calls: each serves `each` calls that follow one another, and is looked up once for those of a
// block.
#pragma once

#include "batch/descents.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>

namespace acdf::batch {

// look_up(file, vector, point) finds a Point.
template <class File, class Point, auto look_up>
class Conditions {
public:
    Conditions(const File& file, const float* vectors, std::size_t each)
        : file_(file), vectors_(vectors), each_(each) {}

    // Looks up those of calls [first, first + count), at most a block.
    void take(std::size_t first, std::size_t count) {
        std::size_t number = first / each_, points = 0;
        for (std::size_t i = 0; i < count; ++number, ++points) {
            look_up(&file_, vectors_ + 3 * number, &points_[points]);
            for (const std::size_t end = std::min(count, (number + 1) * each_ - first); i < end; ++i)
                of_[i] = static_cast<std::uint8_t>(points);
        }
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
