// What targets of probes take in memory, by their headers and options alone: for `acdf batch`.
#pragma once

#include "input/probe/probe.h"

#include <acdf/builder.h>

#include <cstdint>
#include <string>

namespace acdf::tools {

struct TargetMemory {
    std::uint64_t texels = 0;  ///< of the grid that is fitted, at most; 0: nothing is known
    std::uint64_t reading = 0; ///< bytes while the probe is read and resampled
    std::uint64_t target = 0;  ///< bytes of the target that is kept
};

TargetMemory target_memory(const std::string& source, const input::ProbeOptions& reading,
                           const builder::TargetOptions& options);

} // namespace acdf::tools
