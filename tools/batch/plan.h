// What is left to do: jobs whose output is not there, or was made of something else.
#pragma once

#include "tools/batch/jobs.h"
#include "tools/cli/conversion.h"

#include <cstdint>
#include <functional>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

namespace acdf::tools {

/// Options of a job that are none of its kind's, or contradict each other.
struct OptionError : std::runtime_error {
    using std::runtime_error::runtime_error;
};

/// A job's conversion with its options set. Throws OptionError.
using MakeConversion = std::function<std::shared_ptr<Conversion>(const BatchJob& job)>;

/// A job, and whether it is to be done.
struct PlannedJob {
    BatchJob job;
    bool due = true;
    std::string reason;             ///< "new", "up to date", "its options changed from --cells 4096", ...
    std::uint64_t memory = 0;       ///< that it needs, where it is due
    std::uint64_t bytes = 0;        ///< of the output, where it is not
    double relative_variance = 0.0; ///< stored in the output, where it is not due
};

/// Checks the options of all jobs, each set of options once. Adds one line for each job whose options are wrong.
void check_options(BatchJobs& jobs, const MakeConversion& make);

struct PlanOptions {
    bool force = false; ///< all are due, whatever there is
    bool memory = true; ///< estimate it for each job, which reads the headers of images
};

/// Looks at sources and outputs, several at once. Adds a line to `errors` for each output in the way that is no
/// .acdf file, and would be lost.
std::vector<PlannedJob> plan_jobs(const std::vector<BatchJob>& jobs, const std::string& folder,
                                  const PlanOptions& options, const MakeConversion& make,
                                  std::vector<std::string>& errors);

} // namespace acdf::tools
