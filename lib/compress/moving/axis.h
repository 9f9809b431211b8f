// One axis of a grid whose halvings are numbered as a heap: 1 is the whole axis, and 2 n and 2 n + 1 are the halves
// of n.
#pragma once

#include <cstdint>
#include <vector>

namespace acdf::compress {

/// The same halves as HalvedAxis. All levels but the last have every number; of the last, whose ranges are single
/// steps, there are those whose parent has two steps.
class MovingAxis {
public:
    explicit MovingAxis(const std::vector<double>& measure);

    /// Numbers below this are of all levels but the last.
    std::uint32_t end() const { return end_; }
    /// Numbers below this are all there.
    std::uint32_t complete() const { return end_ == borders_.back() ? 2 * end_ : end_; }
    /// The steps of a range: from low(n) up to high(n).
    std::uint32_t low(std::uint32_t n) const { return steps_[n].low; }
    std::uint32_t high(std::uint32_t n) const { return steps_[n].high; }
    bool can_halve(std::uint32_t n) const {
        if (n < end_ / 2) return true;
        return n < end_ && borders_[n - end_ / 2 + 1] - borders_[n - end_ / 2] == 2;
    }
    /// First step of range i of the last level but one, of which there are end() / 2; and of the one behind all.
    std::uint32_t border(std::uint32_t i) const { return borders_[i]; }
    /// Root of the measure of a range.
    float root(std::uint32_t n) const { return roots_[n]; }

private:
    std::uint32_t end_ = 2;
    struct Steps {
        std::uint32_t low, high;
    };

    std::vector<std::uint32_t> borders_;
    std::vector<Steps> steps_;
    std::vector<float> roots_;
};

} // namespace acdf::compress
