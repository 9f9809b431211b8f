// Integrals over every box that halving can make of a grid of two axes (PAPER.md §8).
#pragma once

#include "compress/grid.h"
#include "compress/halvings/axis.h"

#include <array>
#include <cmath>
#include <cstdint>
#include <vector>

namespace acdf::compress {

/// A box: a range of each axis.
struct HalvedBox {
    std::array<std::uint8_t, 2> level{};
    std::array<std::uint32_t, 2> index{};
};

/// All integrals of one non-negative function: positive numbers are added in pairs, so that nothing cancels. Of
/// grids of more than a quarter of `most_values` steps only sums of blocks are kept; what lies within a block is
/// added when it is asked for.
class HalvedTables {
public:
    /// `value(row, column)` is the integral over a step; it is kept, and called from several threads.
    template <class Value>
    HalvedTables(const std::vector<HalvedAxis>& axes, std::size_t most_values, const Value& value)
        : axes_(axes), value_(&value),
          read_([](const void* of, std::uint32_t row, std::uint32_t begin, std::uint32_t end, float* out) {
              for (std::uint32_t c = begin; c < end; ++c) *out++ = (*static_cast<const Value*>(of))(row, c);
          }) {
        choose_kept(most_values);
        fill_finest();
        add_up();
    }

    double at(const HalvedBox& box) const {
        if (box.level[0] > kept_[0] || box.level[1] > kept_[1]) return added(box);
        return double{of(box.level[0],
                         box.level[1])[std::size_t{box.index[0]} * axes_[1].count(box.level[1]) + box.index[1]]};
    }

private:
    const std::vector<float>& of(std::uint32_t level0, std::uint32_t level1) const {
        return tables_[level0 * (kept_[1] + 1) + level1];
    }
    std::vector<float>& of(std::uint32_t level0, std::uint32_t level1) {
        return tables_[level0 * (kept_[1] + 1) + level1];
    }
    void choose_kept(std::size_t most_values);
    double added(const HalvedBox& box) const;
    void fill_finest();
    void add_up();
    void add_rows(std::uint32_t level0);
    void add_columns(std::uint32_t level0, std::uint32_t level1);

    const std::vector<HalvedAxis>& axes_;
    const void* value_;
    /// Values [begin, end) of a row; not each by itself, so that they are inlined.
    void (*read_)(const void* value, std::uint32_t row, std::uint32_t begin, std::uint32_t end, float* out);
    std::array<std::uint32_t, 2> kept_{}; ///< the finest level of each axis that tables are kept of
    std::vector<std::vector<float>> tables_;
};

/// What cells of a grid cost (PAPER.md §5; beside an MIS partner compress/partner.h), in units in which squares fit
/// a float.
class HalvedSums {
public:
    explicit HalvedSums(const Grid& grid, std::size_t most_values = std::size_t{1} << 26);
    HalvedSums(const HalvedSums&) = delete;
    HalvedSums& operator=(const HalvedSums&) = delete;

    const HalvedAxis& axis(std::size_t i) const { return axes_[i]; }
    HalvedBox whole() const { return {}; }
    bool can_halve(const HalvedBox& box, std::size_t axis) const {
        return axes_[axis].can_halve(box.level[axis], box.index[axis]);
    }
    HalvedBox half(HalvedBox box, std::size_t axis, std::uint32_t upper) const {
        box.index[axis] = axes_[axis].lower(box.level[axis], box.index[axis]) + upper;
        ++box.level[axis];
        return box;
    }

    double measure(const HalvedBox& box) const {
        return axes_[0].measure(box.level[0], box.index[0]) * axes_[1].measure(box.level[1], box.index[1]);
    }
    /// The root of the measure times the integral of f^2: positive where f is.
    double alone(const HalvedBox& box) const { return std::sqrt(measure(box) * squares_.at(box)); }
    /// What a cell costs.
    double cost(const HalvedBox& box) const {
        const double cost = alone(box);
        return left_.empty() ? cost : cell_cost(cost, left_[0].at(box));
    }
    /// The share of samples that it should get, in proportion.
    double weight(const HalvedBox& box) const {
        return left_.empty() ? alone(box) : grid_.filling->share(alone(box), left_[0].at(box));
    }
    /// The largest f in a box.
    double peak(const HalvedBox& box) const;
    /// What f was multiplied with.
    double unit() const { return unit_; }
    const Grid& grid() const { return grid_; }

private:
    struct Square {
        const Grid* grid;
        std::vector<float> row_scale, column_scale;
        float operator()(std::uint32_t row, std::uint32_t column) const;
    };
    struct LeftOver {
        const Grid* grid;
        double unit;
        float operator()(std::uint32_t row, std::uint32_t column) const;
    };

    Grid grid_;
    std::vector<HalvedAxis> axes_;
    double unit_;
    Square square_;
    LeftOver left_over_;
    HalvedTables squares_;
    std::vector<HalvedTables> left_; ///< none, or of what is left to the partner
};

} // namespace acdf::compress
