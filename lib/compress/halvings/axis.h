// One axis of a tree of halvings: which ranges of its steps there are (SPEC.md §6.2).
#pragma once

#include <cstdint>
#include <vector>

namespace acdf::compress {

/// The ranges that halving makes of an axis, numbered as a heap: 1 is the whole axis, and 2 n and 2 n + 1 are the
/// halves of n. A range [low, high) is halved at (low + high) / 2, rounded down. All levels but the last have every
/// number; of the last, whose ranges are single steps, there are those whose parent has two steps.
class HalvedAxis {
public:
    explicit HalvedAxis(const std::vector<double>& measure);

    std::uint32_t steps() const { return borders_.back(); }
    /// Numbers below this are of all levels but the last.
    std::uint32_t end() const { return end_; }
    /// Numbers below this are all there.
    std::uint32_t complete() const { return end_ == steps() ? 2 * end_ : end_; }
    /// The steps of a range: from low(n) up to high(n).
    std::uint32_t low(std::uint32_t n) const { return steps_[n].low; }
    std::uint32_t high(std::uint32_t n) const { return steps_[n].high; }
    bool has(std::uint32_t n) const { return n < steps_.size() && steps_[n].high > steps_[n].low; }
    bool can_halve(std::uint32_t n) const {
        if (n < end_ / 2) return true;
        return n < end_ && borders_[n - end_ / 2 + 1] - borders_[n - end_ / 2] == 2;
    }
    /// Root of the measure of a range.
    float root(std::uint32_t n) const { return roots_[n]; }

private:
    struct Steps {
        std::uint32_t low, high;
    };

    std::uint32_t end_ = 2;
    std::vector<std::uint32_t> borders_; ///< of the last level but one
    std::vector<Steps> steps_;
    std::vector<float> roots_;
};

/// A box: the number of a range of rows, and of one of columns.
struct HalvedBox {
    std::uint32_t rows = 1, columns = 1;
};

/// The lower or upper half of a box. Axis 0: its rows are halved, 1: its columns.
inline HalvedBox half(HalvedBox box, int axis, std::uint32_t upper) {
    std::uint32_t& range = axis == 0 ? box.rows : box.columns;
    range = 2 * range + upper;
    return box;
}

/// Rows and columns of a grid.
struct HalvedAxes {
    HalvedAxis rows, columns;

    bool can_halve(HalvedBox box, int axis) const {
        return axis == 0 ? rows.can_halve(box.rows) : columns.can_halve(box.columns);
    }
    double measure(HalvedBox box) const {
        const double root = double{rows.root(box.rows)} * double{columns.root(box.columns)};
        return root * root;
    }
};

} // namespace acdf::compress
