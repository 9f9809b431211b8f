// Where a box is best divided along one axis.
#pragma once

#include "compress/fit/projection.h"

#include <array>
#include <cstdint>
#include <vector>

namespace acdf::compress {

/// A way to divide a box along one axis: where, and how much each knot gains.
struct Division {
    static constexpr std::size_t most_parts = 8; ///< deeper divisions along the same axis join its curve anyway

    std::array<std::uint32_t, most_parts - 1> cuts; ///< ascending, relative to the box
    std::size_t knots = 0;                          ///< so many cuts; 0: of one slice there is no division
    double gain_per_knot = -1.0;
};

/// Memory that divisions reuse.
struct DivisionScratch {
    std::vector<double> measure, energy, left, alone, joined;
};

/// Joins slices bottom-up to one part, then takes the number of parts whose gain per knot is largest. `undivided`
/// is the cost of the whole.
Division divide(const Slices& slices, double undivided, DivisionScratch& scratch);

} // namespace acdf::compress
