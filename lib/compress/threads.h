// Runs work on the number of threads a user asked for.
#pragma once

#include <tbb/info.h>
#include <tbb/task_arena.h>

#include <algorithm>

namespace acdf::compress {

/// Calls `function` where at most `threads` threads (0: all cores; never more than there are) serve its
/// parallel loops.
template <typename Function>
void with_threads(int threads, Function&& function) {
    const int cores = tbb::info::default_concurrency();
    tbb::task_arena arena(threads > 0 ? std::min(threads, cores) : cores);
    arena.execute(function);
}

} // namespace acdf::compress
