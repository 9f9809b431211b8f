// Filling a budget of compressed bytes with builds that only know what they take before compression.
#pragma once

#include <algorithm>
#include <cstdint>
#include <utility>

namespace acdf::build {

/// The largest of a few files of at most `budget` bytes. `build(n)` makes one that takes at most n bytes before
/// compression and fewer after it; the result's `bytes` are those that are stored. How well a file compresses is
/// known only once it is made, and hardly changes with its size: two or three builds are usual.
template <typename Build>
auto fill_compressed(std::uint64_t budget, Build build) {
    constexpr int most_builds = 6;
    auto best = build(budget);
    std::uint64_t plain = budget, last = best.bytes.size();
    for (int builds = 1; builds < most_builds && best.bytes.size() < budget - budget / 50; ++builds) {
        const double grown = 0.99 * double(budget) / double(last);
        plain = static_cast<std::uint64_t>(double(plain) * grown);
        auto next = build(plain);
        const std::uint64_t size = next.bytes.size();
        const bool same = size == last; // nothing is left to store
        last = size;
        if (size <= budget && size > best.bytes.size()) best = std::move(next);
        if (same) break;
    }
    return best;
}

} // namespace acdf::build
