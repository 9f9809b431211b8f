// Timing on machines that others use too: short turns of each candidate, one after the other, by the processor time
// of the thread. The result is the least of a candidate's turns; reads and writes between them are everyone's; each
// round has another order, as who comes next to its like finds more in the caches.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <ctime>
#include <functional>
#include <limits>
#include <numeric>
#include <random>
#include <string>
#include <vector>

namespace acdf_bench {

inline double thread_seconds() {
    timespec time;
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time);
    return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
}

/// Keeps a result without storing it in parts.
template <class T>
inline void keep(const T& value) {
    asm volatile("" : : "m"(value) : "memory");
}

/// One of those that are timed in turns. `calls(first, count)` makes calls number `first` and following.
struct Candidate {
    std::string name;
    std::function<void(std::size_t first, std::size_t count)> calls;
    double least = std::numeric_limits<double>::infinity(); ///< ns a call
};

struct Turns {
    std::size_t rounds = 60, calls = 16384;
    std::size_t period = std::size_t{1} << 18; ///< calls until numbers repeat
    /// Whether 64 MiB of something else are touched before each turn; else what is timed runs as long before it.
    bool evict = false;
};

inline void take_turns(std::vector<Candidate>& candidates, const Turns& turns) {
    static std::vector<std::uint64_t> other;
    if (turns.evict) other.resize(std::size_t{8} << 20);
    std::vector<std::size_t> order(candidates.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::mt19937 random(1);
    for (std::size_t round = 0, first = 0; round < turns.rounds;
         ++round, first = (first + turns.calls) % turns.period) {
        std::shuffle(order.begin(), order.end(), random);
        for (const std::size_t i : order) {
            Candidate& candidate = candidates[i];
            if (turns.evict)
                for (std::size_t k = 0; k < other.size(); k += 8) ++other[k];
            else candidate.calls(turns.period - turns.calls - first, turns.calls);
            const double begin = thread_seconds();
            candidate.calls(first, turns.calls);
            const double ns = (thread_seconds() - begin) * 1e9 / static_cast<double>(turns.calls);
            candidate.least = std::min(candidate.least, ns);
        }
    }
}

} // namespace acdf_bench
