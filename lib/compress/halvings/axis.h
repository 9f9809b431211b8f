// One axis of a tree of halvings: which ranges of its steps there are, level by level (SPEC.md §6.2).
#pragma once

#include <cstdint>
#include <vector>

namespace acdf::compress {

/// The ranges that halving makes of an axis. Range 0 of level 0 is the whole axis; a range [low, high) is halved at
/// (low + high) / 2, rounded down. Above the last level there are 2^level ranges; the last level has one a step, so
/// that a range of two steps before it has two halves and a range of one step has none.
class HalvedAxis {
public:
    explicit HalvedAxis(const std::vector<double>& measure);

    std::uint32_t levels() const { return levels_; } ///< number of the last level
    std::uint32_t count(std::uint32_t level) const {
        return static_cast<std::uint32_t>(borders_[level].size()) - 1;
    }
    /// First step of range i, and of the one after it.
    std::uint32_t low(std::uint32_t level, std::uint32_t i) const { return borders_[level][i]; }
    std::uint32_t high(std::uint32_t level, std::uint32_t i) const { return borders_[level][i + 1]; }
    /// Number, in the level below, of the lower half of range i; the upper half follows it.
    std::uint32_t lower(std::uint32_t level, std::uint32_t i) const {
        return level + 1 < levels_ ? 2 * i : borders_[level][i];
    }
    bool can_halve(std::uint32_t level, std::uint32_t i) const {
        return level < levels_ && borders_[level][i + 1] - borders_[level][i] > 1;
    }
    double measure(std::uint32_t level, std::uint32_t i) const { return measures_[level][i]; }

private:
    std::uint32_t levels_ = 0;
    std::vector<std::vector<std::uint32_t>> borders_; ///< of each level, count + 1
    std::vector<std::vector<double>> measures_;       ///< of each level, count
};

} // namespace acdf::compress
