// The cells of a cascade before it is stored, and sums over them: slow, and independent of lib/measure.
#pragma once

#include "compress/cascade.h"
#include "compress/target.h"

#include <cstdint>
#include <vector>

namespace acdf_test {

struct CascadeCell {
    std::uint32_t low[2], high[2]; ///< by axis number: 0 columns, 1 rows
    double tilt[2] = {0.0, 0.0};
    double probability = 1.0;
};

inline void collect_cells(const acdf::compress::Cascade& cascade, std::size_t at, const CascadeCell& from,
                          std::vector<CascadeCell>& cells) {
    const acdf::compress::Curve& curve = cascade.curves[at];
    for (std::size_t s = 0; s < curve.segments(); ++s) {
        CascadeCell cell = from;
        cell.probability *= curve.probability[s];
        if (s > 0) cell.low[curve.axis] = curve.knots[s - 1];
        if (s < curve.knots.size()) cell.high[curve.axis] = curve.knots[s];
        if (!curve.tilts.empty()) cell.tilt[curve.axis] = curve.tilts[s];
        const std::int32_t child = curve.children.empty() ? -1 : curve.children[s];
        if (child < 0) cells.push_back(cell);
        else collect_cells(cascade, static_cast<std::size_t>(child), cell, cells);
    }
}

inline std::vector<CascadeCell> cells_of(const acdf::compress::Cascade& cascade,
                                         const acdf::compress::Target& target) {
    std::vector<CascadeCell> cells;
    const CascadeCell whole = {{0, 0}, {target.columns, target.rows}};
    collect_cells(cascade, cascade.roots[0], whole, cells);
    return cells;
}

/// Measure of a cell, and the integrals of f and of its square over it.
struct CellSums {
    long double measure = 0.0L, f = 0.0L, square = 0.0L;
};

inline CellSums cell_sums(const CascadeCell& cell, const acdf::compress::Target& target) {
    CellSums sums;
    for (std::uint32_t r = cell.low[1]; r < cell.high[1]; ++r)
        for (std::uint32_t c = cell.low[0]; c < cell.high[0]; ++c) {
            const long double measure = static_cast<long double>(target.row_measure[r]) * target.column_measure[c];
            const long double f = target.row(r)[c];
            sums.measure += measure;
            sums.f += f * measure;
            sums.square += f * f * measure;
        }
    return sums;
}

} // namespace acdf_test
