#include "compress/parallel.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

namespace acdf::compress {

void parallel_parts(std::size_t begin, std::size_t end, std::size_t grain, const PartBody& body) {
    tbb::parallel_for(tbb::blocked_range<std::size_t>(begin, end, grain),
                      [&](const tbb::blocked_range<std::size_t>& part) { body(part.begin(), part.end()); });
}

} // namespace acdf::compress
