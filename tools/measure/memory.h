// What a file takes, beside what baselines take.
#pragma once

#include "measure/samplers/light_samplers.h"

#include <cinttypes>
#include <cstdio>

namespace acdf::tools {

inline void print_bytes(const File& file) {
    std::printf("  bytes                  %" PRIu64 "   %" PRIu64 " in memory, with tables made at load\n",
                file.size(), measure::memory_of(file));
}

} // namespace acdf::tools
