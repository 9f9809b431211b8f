// How much memory there is for jobs.
#pragma once

#include "tools/batch/run.h"

#include <cstdint>

namespace acdf::tools {

/// Bytes that this process could still use: what the machine has available, or what its control group (of a
/// container or a cluster's job) leaves it, whichever is less. 0 where neither is known.
std::uint64_t available_memory();

/// Lowers limits to the address space that `ulimit -v` leaves, less what threads reserve of it. oneTBB may wait for
/// ever once there is no memory for its own tasks, so jobs that would come near are refused before they start.
void keep_within_address_space(BatchLimits& limits);

} // namespace acdf::tools
