// A cascade as a fit makes it, before it is stored: a tree of curves with real probabilities.
#pragma once

#include <cstdint>
#include <vector>

namespace acdf::compress {

/// A 1D CDF on one sampled axis. A segment ends (child -1) or has a child curve that refines it.
struct Curve {
    std::uint32_t axis = 0;
    std::vector<std::uint32_t> knots;   ///< interior positions, strictly increasing; segments - 1 of them
    std::vector<double> probability;    ///< one a segment, >= 0, sum 1
    std::vector<std::int32_t> children; ///< empty (all segments end) or one a segment: -1 or an index > own
    std::vector<double> tilts;          ///< empty or one a segment, in (-1, 1): see AcdfRange::tilt

    std::size_t segments() const { return knots.size() + 1; }
};

/// Curves, children after their parents; `roots` has one a bin.
struct Cascade {
    std::vector<Curve> curves;
    std::vector<std::uint32_t> roots;
};

} // namespace acdf::compress
