// The tree of a local environment map that points without a normal sample from.
#pragma once

#include "compress/fit/fit.h"

#include <algorithm>
#include <cstdint>

namespace acdf::compress {

constexpr std::uint64_t kLeastWholeBytes = 64;

/// Of at most `bytes`, as accurate as that of an environment file whose tree takes as many: its root is unit 0.
inline Fitted fit_whole(const Target& target, std::uint64_t bytes) {
    FitOptions options;
    options.goal = {Goal::Kind::budget, 0, std::max(bytes, kLeastWholeBytes), 0.0};
    return fit(target, options);
}

} // namespace acdf::compress
