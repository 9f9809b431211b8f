// What rows of visibility cells hold: how much is believed of the points of a cell.
#pragma once

#include "compress/visibility/cells.h"

#include <acdf/visibility/cells.h>

#include <cstdint>
#include <vector>

namespace acdf::compress {

/// Which cells points lie in, as readers find them.
class CellNumbers {
public:
    /// Of `header` only bounds and counts matter: points are among the cells.
    CellNumbers(const AcdfVisibility& header, const std::vector<AcdfVisibilitySplit>& splits, std::uint32_t cells);
    CellNumbers(const CellNumbers&) = delete;
    CellNumbers& operator=(const CellNumbers&) = delete;

    std::uint32_t count() const { return static_cast<std::uint32_t>(rows_.size()); }
    /// The number of cells if it lies outside.
    std::uint32_t of(const VisibilityPoint& point) const;

private:
    AcdfVisibility header_;
    std::vector<std::uint8_t> rows_;
    AcdfVisibilityTable table_{};
};

/// Numbers of points, cell by cell; those outside of all cells come last.
struct PointsOfCells {
    std::vector<std::uint32_t> point;
    std::vector<std::uint32_t> first; ///< where those of a cell begin, and those of the next
};
PointsOfCells points_of_cells(const CellNumbers& numbers, const std::vector<VisibilityPoint>& points);

/// The code of the visibility nearest to a factor.
std::uint8_t visibility_code(double factor);

/// What the rows of a range of cells are made of, cells x parts each.
struct VisibilityRows {
    std::vector<float> all;     ///< what parts would give to the points of the cell
    std::vector<float> factors; ///< visible_factor
};

/// Shoots rays to `parts`, which are those of `coarse` cut anew, from all points of the cells below
/// `node`. Factors have the caution that serves best points that rows have not seen: each estimated from the
/// others. `known`: of these cells. `dark`: as of trace_visibility. `beside_cosine`: for what
/// as many samples of the cosine leave over (BesideCosine).
VisibilityRows visibility_rows(const VisibilityParts& parts, const VisibilityParts& coarse,
                               const std::vector<VisibilitySums>& known, const VisibilityCells& tree,
                               std::uint32_t node, const PointsOfCells& of,
                               const std::vector<VisibilityPoint>& points, const Occluded& occluded, double dark,
                               bool beside_cosine);

} // namespace acdf::compress
