// Runs jobs side by side, within a bound on memory.
#pragma once

#include "tools/batch/plan.h"
#include "tools/batch/report.h"

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

namespace acdf::tools {

struct BatchLimits {
    int threads = 1;          ///< in all
    int workers = 1;          ///< jobs at once
    std::uint64_t memory = 0; ///< bytes for all jobs at once
};

/// Called as jobs end, and as they go on with `result` null; one call at a time. `share`: of all work that is done.
using BatchWatcher = std::function<void(double share, const JobResult* result)>;

/// Does what is due: the jobs that need most memory first, each started as soon as what it needs is free. A job
/// that needs more than the bound by itself fails without a start. Threads that no job runs on help those that run;
/// files do not depend on that. Results are in the order of `plan`. A job that fails leaves its output as it was.
std::vector<JobResult> run_jobs(const std::vector<PlannedJob>& plan, const std::string& folder,
                                const BatchLimits& limits, const MakeConversion& make, const BatchWatcher& watcher);

} // namespace acdf::tools
