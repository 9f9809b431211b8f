// What rows of visibility cells hold: how much is believed of the points of a cell.
#pragma once

#include "compress/visibility/cells.h"

#include <acdf/visibility.h>

#include <cstdint>
#include <vector>

namespace acdf::compress {

/// Which cells points lie in, mixed as readers do.
class CellNumbers {
public:
    /// Of `header` only bounds and counts matter: points are among the cells.
    CellNumbers(const AcdfVisibility& header, const std::vector<AcdfVisibilitySplit>& splits, std::uint32_t cells);
    CellNumbers(const CellNumbers&) = delete;
    CellNumbers& operator=(const CellNumbers&) = delete;

    template <class Visit>
    void for_each(const VisibilityPoint& point, const Visit& visit) const {
        AcdfVisibilityMixture mix;
        acdf_visibility_at(&table_, point.position.data(), point.normal.data(), &mix);
        for (int k = 0; k < mix.count; ++k)
            visit(static_cast<std::uint32_t>(mix.row[k] - rows_.data()), mix.weight[k]);
    }
    /// The first of them; the number of cells if it lies outside.
    std::uint32_t of(const VisibilityPoint& point) const;

private:
    AcdfVisibility header_;
    std::vector<std::uint8_t> rows_;
    AcdfVisibilityTable table_{};
};

/// A point and a cell that it counts for.
struct VisibleShare {
    std::uint32_t point = 0, cell = 0;
    float weight = 0.0f;
};

/// Points near a border count for the cells on both sides of it, as readers mix them. Those of a cell come
/// together.
std::vector<VisibleShare> shares_of(const CellNumbers& numbers, const std::vector<VisibilityPoint>& points);

/// The code of the visibility nearest to a factor.
std::uint8_t visibility_code(double factor);

/// What the rows of a range of cells are made of, cells x parts each.
struct VisibilityRows {
    std::vector<float> all;     ///< what parts would give to the points of the cell
    std::vector<float> factors; ///< visible_factor
};

/// Shoots rays to `parts`, which are those of `coarse` cut anew, from all points that count for the cells of
/// `range`. Factors have the caution that serves best points that rows have not seen: each estimated from the
/// others. `known`: of these cells. `dark`: as of trace_visibility.
VisibilityRows visibility_rows(const VisibilityParts& parts, const VisibilityParts& coarse,
                               const std::vector<VisibilitySums>& known, const VisibilityCells& tree,
                               std::uint32_t node, const std::vector<VisibleShare>& shares,
                               const std::vector<VisibilityPoint>& points, const Occluded& occluded, double dark);

} // namespace acdf::compress
