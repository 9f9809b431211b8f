// A cascade as a fit makes it, before it is stored: a tree of curves with real probabilities.
#pragma once

#include <cstdint>
#include <utility>
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

/// Appends the curves of one bin.
inline void append(const Cascade& bin, Cascade& out) {
    const auto first = static_cast<std::int32_t>(out.curves.size());
    out.roots.push_back(bin.roots.front() + static_cast<std::uint32_t>(first));
    for (Curve curve : bin.curves) {
        for (std::int32_t& child : curve.children)
            if (child >= 0) child += first;
        out.curves.push_back(std::move(curve));
    }
}

} // namespace acdf::compress
