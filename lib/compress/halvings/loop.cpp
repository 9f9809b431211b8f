#include "compress/halvings/loop.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

namespace acdf::compress {

std::size_t Loop::slots() const {
    return alone_ ? 1 : static_cast<std::size_t>(tbb::this_task_arena::max_concurrency());
}

void Loop::share(std::size_t count, std::size_t grain, const void* body, Call call) {
    tbb::parallel_for(tbb::blocked_range<std::size_t>(0, count, grain),
                      [&](const tbb::blocked_range<std::size_t>& part) {
                          call(body, part.begin(), part.end(),
                               static_cast<std::size_t>(tbb::this_task_arena::current_thread_index()));
                      });
}

} // namespace acdf::compress
