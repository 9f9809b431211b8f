// Sharing a batch between machines that do not talk to each other.
#pragma once

#include "tools/batch/jobs.h"

#include <cstdint>
#include <string>
#include <vector>

namespace acdf::tools {

/// Part `index` (from 1) of `count`.
struct Shard {
    std::uint32_t index = 1, count = 1;
};

/// "3/8", or "slurm": the task of the Slurm array that this runs in, whose indices must be without gaps. Throws
/// std::invalid_argument, with what is wrong.
Shard parse_shard(const std::string& text);

/// The jobs of a shard, in their order. Depends on the jobs alone, so that all shards together are all jobs;
/// balanced by what jobs cost: the costliest first, each to the shard that has least.
std::vector<BatchJob> jobs_of_shard(const std::vector<BatchJob>& jobs, const Shard& shard);

/// A number for the jobs' outputs, sources and options, in any order: reports of one batch have the same.
std::string batch_id(const std::vector<BatchJob>& jobs);

} // namespace acdf::tools
