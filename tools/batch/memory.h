// How much memory there is for jobs.
#pragma once

#include <cstdint>

namespace acdf::tools {

/// Bytes that this process could still use: what the machine has available, or what its control group (of a
/// container or a cluster's job) leaves it, whichever is less. 0 where neither can be told.
std::uint64_t available_memory();

} // namespace acdf::tools
