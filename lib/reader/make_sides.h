// Cells of trees as parts of the eight pieces of the sphere, or as boxes of the octahedral square (acdf/cells.h).
#pragma once

#include "growable.h"

#include <acdf/cells.h>
#include <acdf/grid.h>

#include <cstddef>
#include <cstdint>

namespace acdf {

/// A cell as the walk of a tree finds it.
struct Cell {
    double probability;
    double low[2], high[2];          ///< random numbers
    std::uint32_t first[2], last[2]; ///< positions
    bool dark, tilted;
};

/// The border of a curve before segment i, or behind the last one: its cumulative value, and as a part of all.
struct Cut {
    std::uint32_t cumulative;
    double part;
};
inline Cut cut_of(const AcdfCurve& curve, std::uint32_t i) {
    const std::uint32_t cumulative = acdf_curve_cumulative(&curve, i);
    return {cumulative, cumulative / static_cast<double>(acdf_curve_maximum(&curve))};
}

/// The part of the cell `above` that segment i of its curve leaves, between two cuts.
inline Cell part_of(const Cell& above, const AcdfCurve& curve, std::uint32_t i, const Cut& low, const Cut& high) {
    const std::uint32_t axis = acdf_curve_axis(&curve), end = acdf_curve_maximum(&curve);
    const double width = above.high[axis] - above.low[axis];
    Cell cell = above;
    cell.dark = high.cumulative == low.cumulative;
    cell.probability *= static_cast<double>(high.cumulative - low.cumulative) / end;
    cell.low[axis] = above.low[axis] + width * low.part;
    if (high.cumulative != end) cell.high[axis] = above.low[axis] + width * high.part;
    AcdfRange range = {above.first[axis], above.last[axis], 0.0};
    acdf_curve_narrow(&curve, i, &range);
    cell.first[axis] = range.low;
    cell.last[axis] = range.high;
    cell.tilted = curve.tilts ? above.tilted || range.tilt != 0.0 : above.tilted;
    return cell;
}

/// Calls add(cell) for each cell of the tree at `at`, which lies in the cell `above`, in their order, as long as it
/// returns true. Returns whether it always did. A path passes at most 64 curves.
template <class Add>
bool each_cell(const std::uint8_t* tree, std::uint32_t at, const Cell& above, const Add& add) {
    const AcdfCurve curve = acdf_curve_at(tree, at);
    Cut low = {0, 0.0};
    for (std::uint32_t i = 0; i < curve.segments; ++i) {
        const Cut high = cut_of(curve, i + 1);
        const std::uint32_t link = acdf_curve_link(&curve, i);
        const Cell cell = part_of(above, curve, i, low, high);
        if (link == 0 ? !add(cell) : !each_cell(tree, at + link, cell, add)) return false;
        low = high;
    }
    return true;
}

/// The part of a cell's side that lies in one piece of the sphere: from low to high random numbers.
struct Side {
    std::uint32_t piece; ///< quarter, or whether it is south; 0 on the square
    double low, high;    ///< random numbers
    double local[2];     ///< at low and high: local azimuth, 1 - |z|, or 1 - 2 u, 2 v - 1
    double margin[2];    ///< of `local`, in which nothing is sure
    double key[2];       ///< of acdf_direction_place: the lesser, and the greater
    double beyond;       ///< the first key behind its piece; that of a quarter is the next one's
    double ends[2];      ///< tangents of azimuth or 1 - |z|: the lesser, and the greater; not on the square

    std::uint32_t first_key() const { return static_cast<std::uint32_t>(key[0]); }
    /// In another quarter local azimuths are others: it is not to be looked for there.
    std::uint32_t last_key() const { return static_cast<std::uint32_t>(key[1] < beyond ? key[1] : beyond - 1.0); }
};

/// Cuts cells of a grid.
class Sides {
public:
    explicit Sides(const AcdfGrid& grid) : grid_(grid), columns_(grid.columns), rows_(grid.rows) {}

    /// Trigonometry of each column and row once, unless they are more than `most`. False where memory fails.
    bool remember(std::size_t most);
    /// Of axis 0 into out[5]; returns how many.
    int azimuths(const Cell& cell, Side* out) const;
    /// Of axis 1 into out[2]; returns how many.
    int heights(const Cell& cell, Side* out) const;
    /// acdf_grid_height of a cell.
    double height(const Cell& cell) const;
    /// Bits of a key.
    std::uint32_t key_bits() const { return octahedral() ? ACDF_SQUARE_BITS : ACDF_DIRECTION_BITS; }
    /// Density of a cell without tilts, sr^-1; 0 for a dark one.
    float density(const Cell& cell) const;

private:
    /// What the trigonometry of a border between rows gives.
    struct Row {
        double z, cap; ///< cosine, 1 - |cosine|
        double margin; ///< of the angle, as a difference of z
    };
    bool octahedral() const { return acdf_grid_is_octahedral(&grid_) != 0; }
    int square_side(const Cell& cell, int axis, Side& out) const;
    double tangent(std::uint32_t column) const;
    Row row(std::uint32_t row) const;
    static Row row_of(std::uint32_t row, std::uint32_t rows);

    AcdfGrid grid_;
    std::uint32_t columns_, rows_;
    Growable<double> tangents_;
    Growable<Row> heights_;
};

} // namespace acdf
