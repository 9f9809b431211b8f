// Integrals over every box that halving can make of a grid of two axes (PAPER.md §8).
#pragma once

#include "compress/halvings/axis.h"
#include "compress/halvings/loop.h"

#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <memory>
#include <vector>

namespace acdf::compress {

/// What is integrated: numbers that are not negative, one a step, row by row.
class HalvedRows {
public:
    virtual ~HalvedRows() = default;
    /// Steps [begin, end) of a row: where they are, or in `scratch`, which has room for them. Called by several
    /// threads at once.
    virtual const float* read(std::uint32_t row, std::uint32_t begin, std::uint32_t end, float* scratch) const = 0;
    /// Called before rows [first, last) are read by `slot` of the loop; no two at once with the same slot.
    virtual void prepare(std::uint32_t, std::uint32_t, std::size_t) {}
};

/// All integrals, added in pairs so that nothing cancels. Of large grids only sums of blocks are kept; what lies
/// within a block is added when it is asked for. Axes and rows must outlive it.
class HalvedTable {
public:
    HalvedTable(const HalvedAxes& axes, HalvedRows& rows, std::size_t most_values);

    /// Rows [first, last) are new: make() adds up what depends on them.
    void mark(std::uint32_t first, std::uint32_t last);
    void make(const Loop& loop);

    float at(HalvedBox box) const {
        return box.rows < end_[0] && box.columns < end_[1] ? table_[std::size_t{box.rows} * stride_ + box.columns]
                                                           : added(box);
    }
    /// Numbers of rows and columns below which sums are in the table, and all there.
    std::uint32_t complete_rows() const;
    std::uint32_t complete_columns() const;
    /// Sums of all boxes of a range of rows.
    const float* of_rows(std::uint32_t rows) const { return table_.get() + rows * stride_; }

private:
    float added(HalvedBox box) const;
    float* of_rows(std::uint32_t rows) { return table_.get() + rows * stride_; }
    void prepare(std::uint32_t first, std::uint32_t last, std::size_t slot);
    void add_steps(std::uint32_t range, float* scratch);
    void add_columns(const float* steps, float* sums) const;
    void add_halves(std::uint32_t range);

    const HalvedAxes& axes_;
    HalvedRows& rows_;
    bool whole_;          ///< whether the table has the last levels, too
    std::size_t end_[2];  ///< the first numbers that are not in the table
    std::size_t kept_[2]; ///< the first numbers of the finest level that has all of them
    std::size_t stride_;
    struct Free {
        void operator()(float* memory) const { std::free(memory); }
    };
    std::unique_ptr<float[], Free> table_; ///< of calloc: pages that are written once
    std::vector<std::uint8_t> dirty_;      ///< of each range of rows of that level
    std::vector<std::vector<float>> scratch_;
};

} // namespace acdf::compress
