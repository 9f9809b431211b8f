// What is left to do: jobs whose output is not there, or was made of something else.
#pragma once

#include "tools/batch/jobs.h"
#include "tools/cli/conversion.h"

#include <CLI/CLI.hpp>

#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

namespace acdf::tools {

/// A new conversion of the kind named so.
using MakeConversion = std::function<std::unique_ptr<Conversion>(const std::string& kind)>;

/// A job's conversion with its options set. Throws CLI::ParseError where they are none of the kind's or contradict
/// each other.
class JobConversion {
public:
    JobConversion(const BatchJob& job, const MakeConversion& make);

    Conversion* operator->() { return conversion_.get(); }
    Conversion& operator*() { return *conversion_; }

private:
    std::unique_ptr<Conversion> conversion_;
    CLI::App command_;
};

/// A job, and whether it is to be done.
struct PlannedJob {
    BatchJob job;
    bool due = true;
    std::string reason;             ///< "new", "up to date", "its options changed from --cells 4096", ...
    std::uint64_t memory = 0;       ///< that it needs, where it is due
    std::uint64_t bytes = 0;        ///< of the output, where it is not
    double relative_variance = 0.0; ///< as the output tells it, where it is not due
};

/// Checks the options of all jobs, each set of options once. Adds one line for each job whose options are wrong.
void check_options(BatchJobs& jobs, const MakeConversion& make);

struct PlanOptions {
    bool force = false; ///< all are due, whatever there is
    bool memory = true; ///< tell it of each job, which reads the headers of images
};

/// Looks at sources and outputs, several at once. Adds a line to `errors` for each output in the way that is no
/// .acdf file, and would be lost.
std::vector<PlannedJob> plan_jobs(const std::vector<BatchJob>& jobs, const std::string& folder,
                                  const PlanOptions& options, const MakeConversion& make,
                                  std::vector<std::string>& errors);

} // namespace acdf::tools
