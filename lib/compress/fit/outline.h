// Which parts of a pruned partition are the segments of which curves.
#pragma once

#include "compress/fit/partition.h"
#include "compress/fit/prune.h"

#include <cstdint>
#include <vector>

namespace acdf::compress {

/// The curves of a pruned partition in the order in which they are stored, parents before their children.
struct Outline {
    struct Segment {
        std::uint32_t part;
        std::int32_t child; ///< its curve, or -1
    };
    struct Curve {
        std::uint32_t part;                 ///< whose divisions it holds
        std::uint32_t first = 0, count = 0; ///< its segments
        std::size_t axis = 0;               ///< of the grid
    };

    std::vector<Curve> curves;
    std::vector<Segment> segments;

    const Segment* begin(const Curve& curve) const { return segments.data() + curve.first; }
    const Segment* end(const Curve& curve) const { return begin(curve) + curve.count; }
};

/// For each part the sum of the shares of the cells below it; of their costs where all shares are 0, as they are
/// where few cells stand for light that an MIS partner nearly covers.
std::vector<double> shares_below(const PruneNodes& nodes, const Pruned& pruned);

/// Divisions along the same axis become one curve. `cost` is shares_below: where it is 0, nothing is refined.
Outline outline(const PruneNodes& nodes, const Pruned& pruned, const std::vector<double>& cost);

/// The probability of a segment of the curve of part `whole`.
inline double segment_probability(const std::vector<double>& cost, std::uint32_t whole, std::uint32_t segment) {
    return cost[whole] > 0.0 ? cost[segment] / cost[whole] : 1.0;
}

} // namespace acdf::compress
