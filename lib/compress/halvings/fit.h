// The variance fit of an environment: a tree of halvings (docs/method.md).
#pragma once

#include "compress/fit/fit.h"
#include "compress/halvings/halvings.h"

#include <functional>

namespace acdf::compress {

/// What a tree of halvings is to reach.
struct HalvingsOptions {
    Goal goal;
    /// How many bytes chunk HALV may have within a goal of bytes.
    std::uint64_t chunk_bytes = 0;
    /// A goal of variance is out of reach where it takes a larger chunk.
    std::uint64_t most_bytes = std::numeric_limits<std::uint64_t>::max();
    double max_weight = 0.0; ///< the largest f/p over its mean; 0: no bound
    Progress progress;
};

/// The tree that has the least noise within the goal, with as many bits a code as serve it best. Deterministic for
/// any number of threads. Throws std::invalid_argument where the target has no energy or the goal is 0 cells, and
/// std::runtime_error where the goal is out of reach: the message says what can be had.
Halvings fit_halvings(const Target& target, const HalvingsOptions& options);

} // namespace acdf::compress
