// A non-negative function on a grid of any number of axes, as the variance fit sees it.
#pragma once

#include "compress/partner.h"
#include "compress/target.h"

#include <cstdint>
#include <vector>

namespace acdf::compress {

/// f >= 0, constant on each box of a grid. `values` is row-major, the last axis fastest, and is not owned: it must
/// outlive the grid.
struct Grid {
    std::vector<std::uint32_t> shape;         ///< steps of each axis; 1 to ACDF_MAX_AXES axes
    std::vector<std::vector<double>> measure; ///< for each axis one a step, > 0
    std::vector<std::uint32_t> axes;          ///< axis numbers in the file
    const float* values = nullptr;
    const float* peaks = nullptr; ///< largest value within each box of the grid, laid out alike; null: `values`

    /// Beside an MIS partner (compress/partner.h), laid out alike: what steps cost if they are left to it, and at
    /// best; both per measure. Null: without any.
    const float *left = nullptr, *least = nullptr;
    const Filling* filling = nullptr; ///< how a cell's share follows from its costs

    std::size_t dimensions() const { return shape.size(); }
};

/// Axis 0 of the grid are the target's rows, axis 1 its columns.
inline Grid grid_of(const Target& target) {
    return {{target.rows, target.columns},
            {target.row_measure, target.column_measure},
            {target.row_axis, target.column_axis},
            target.values.data(),
            target.peaks.empty() ? nullptr : target.peaks.data(),
            target.left.empty() ? nullptr : target.left.data(),
            target.least.empty() ? nullptr : target.least.data(),
            target.filling.get()};
}

/// The integral of f, by compensated summation.
double integral(const Grid& grid);

} // namespace acdf::compress
