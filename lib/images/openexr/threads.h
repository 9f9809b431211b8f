// How many threads OpenEXR uses.
#pragma once

#include <OpenEXR/ImfThreading.h>

#include <cstdint>
#include <thread>

namespace acdf::images {

/// As OpenEXR counts them: those beside the one that asks. `wanted` 0: all cores.
inline int thread_count(int wanted) {
    const int count = wanted == 0 ? static_cast<int>(std::thread::hardware_concurrency()) : wanted;
    return count > 1 ? count : 0;
}

/// Once: others may be reading. Not for small images, which take longer with them.
inline void start_threads(int count, std::int64_t pixels) {
    constexpr std::int64_t kPixelsOfThreads = 1 << 20;
    if (count == 0 || pixels < kPixelsOfThreads) return;
    static const bool started = (Imf::setGlobalThreadCount(count), true);
    static_cast<void>(started);
}

} // namespace acdf::images
