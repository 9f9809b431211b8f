// Work that may be done by threads of the caller's.
#pragma once

#include <acdf/parallel.h>

#include <cstddef>

namespace acdf {

/// Calls each(i) for each i < count: by the caller's threads, where it gave any.
template <class Each>
void in_parallel(const AcdfParallel& parallel, std::size_t count, const Each& each) noexcept {
    const auto task = [](void* of, std::size_t i) { (*static_cast<const Each*>(of))(i); };
    void* const of = const_cast<void*>(static_cast<const void*>(&each));
    if (parallel.run) return parallel.run(parallel.context, count, task, of);
    for (std::size_t i = 0; i < count; ++i) each(i);
}

} // namespace acdf
