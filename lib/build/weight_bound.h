// Keeping a bound on weights, which only a finished file shows.
#pragma once

#include <cstdio>
#include <limits>
#include <stdexcept>

namespace acdf::build {

/// A file whose measured weights are at most `max_weight` times their mean; 0: any file. `build(bound)` makes one
/// whose fit holds the weights that it knows of to `bound` (0: as it sees fit); what it does not know of is found
/// by measuring, and the bound is tightened. Throws std::runtime_error where that does not help.
template <typename Build>
auto within_weight(double max_weight, const Build& build) {
    constexpr int kMostBuilds = 6;
    auto made = build(max_weight);
    double bound = max_weight;
    double before = std::numeric_limits<double>::infinity();
    for (int builds = 1; max_weight > 0.0 && made.accuracy.max_weight > max_weight; ++builds) {
        const bool stuck = made.accuracy.max_weight > 0.98 * before;
        before = made.accuracy.max_weight;
        if (stuck || builds == kMostBuilds) {
            char text[160];
            std::snprintf(text, sizeof text,
                          "a largest weight of %.9g is out of reach at this size; it came to %.6g", max_weight,
                          made.accuracy.max_weight);
            throw std::runtime_error(text);
        }
        bound *= 0.9 * max_weight / made.accuracy.max_weight;
        made = build(bound);
    }
    return made;
}

} // namespace acdf::build
