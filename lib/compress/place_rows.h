// What rows of places hold: how much is believed of the points of a cell.
#pragma once

#include "compress/place_cells.h"

#include <acdf/places.h>

#include <cstdint>
#include <vector>

namespace acdf::compress {

/// Which cells points lie in, mixed as readers do.
class CellNumbers {
public:
    /// Of `header` only bounds and counts matter: points are among the cells.
    CellNumbers(const AcdfPlaces& header, const std::vector<AcdfPlaceSplit>& splits, std::uint32_t cells);
    CellNumbers(const CellNumbers&) = delete;
    CellNumbers& operator=(const CellNumbers&) = delete;

    template <class Visit>
    void for_each(const PlacePoint& point, const Visit& visit) const {
        AcdfPlaceMixture mix;
        acdf_place_at(&table_, point.position.data(), point.normal.data(), &mix);
        for (int k = 0; k < mix.count; ++k)
            visit(static_cast<std::uint32_t>(mix.row[k] - rows_.data()), mix.weight[k]);
    }
    /// The first of them; the number of cells if it lies outside.
    std::uint32_t of(const PlacePoint& point) const;

private:
    AcdfPlaces header_;
    std::vector<std::uint8_t> rows_;
    AcdfPlaceTable table_{};
};

/// What rows are made of, cells x parts each.
struct PlaceRows {
    std::vector<float> all;     ///< what parts would give to the points of the cell
    std::vector<float> factors; ///< place_factor
};

/// Factors with the caution that serves best points that rows have not seen: each by what the others tell. `light`
/// is divided anew by what cells know of it.
PlaceRows place_rows(const PlaceCells& tree, const CellNumbers& numbers, PlaceLight& light,
                     const std::vector<PlacePoint>& points);

} // namespace acdf::compress
