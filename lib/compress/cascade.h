// A cascade as a fit makes it, before it is stored: a tree of curves with real probabilities.
#pragma once

#include <array>
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

/// The first curve within a tile, to which no other curve leads.
struct TileRoot {
    std::uint32_t curve = 0;
    double reach = 0.0;                 ///< how often sampling comes to it
    std::array<std::uint32_t, 2> low{}; ///< where the tile begins on axes 0 and 1
};

/// Curves, children after their parents; `roots` has one a bin.
struct Cascade {
    std::vector<Curve> curves;
    std::vector<std::uint32_t> roots;
    std::vector<TileRoot> tiles{}; ///< where curves within tiles are no parts of a tree of the whole
};

} // namespace acdf::compress
