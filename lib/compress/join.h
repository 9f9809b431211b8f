// Joining neighbours bottom-up, the cheapest pair first.
#pragma once

#include <cstddef>
#include <cstdint>
#include <queue>
#include <vector>

namespace acdf::compress {

/// Performs up to `joins` joins among `count` items in a line. `raise(a, b)` tells what joining item a with
/// its right neighbour b costs; `join(a, b, cost)` makes a stand for both and b vanish.
/// Ties go to the leftmost pair. O(count log count) calls.
template <class Raise, class Join>
void join_neighbours(std::size_t count, std::size_t joins, const Raise& raise, const Join& join) {
    struct Pair {
        double raise;
        std::uint32_t left;
        std::uint32_t stamp; // of the left item when the raise was computed
        bool operator<(const Pair& other) const {
            return raise != other.raise ? raise > other.raise : left > other.left;
        }
    };
    constexpr std::uint32_t kNone = 0xFFFFFFFFu;
    std::vector<std::uint32_t> next(count), previous(count), stamp(count, 0);
    std::vector<Pair> pairs;
    for (std::size_t i = 0; i < count; ++i) {
        next[i] = i + 1 < count ? static_cast<std::uint32_t>(i + 1) : kNone;
        previous[i] = i > 0 ? static_cast<std::uint32_t>(i - 1) : kNone;
        if (i + 1 == count) break;
        pairs.push_back({raise(i, i + 1), static_cast<std::uint32_t>(i), 0});
    }
    std::priority_queue<Pair> queue(std::less<Pair>(), std::move(pairs));
    const auto push = [&](std::uint32_t left) {
        ++stamp[left];
        if (next[left] != kNone) queue.push({raise(left, next[left]), left, stamp[left]});
    };
    while (joins > 0 && !queue.empty()) {
        const Pair pair = queue.top();
        queue.pop();
        if (pair.stamp != stamp[pair.left]) continue;
        const std::uint32_t a = pair.left, b = next[a];
        join(a, b, pair.raise);
        next[a] = next[b];
        if (next[a] != kNone) previous[next[a]] = a;
        ++stamp[b]; // whatever is queued for b is void
        push(a);
        if (previous[a] != kNone) push(previous[a]);
        --joins;
    }
}

} // namespace acdf::compress
