// What became of the jobs of a batch: as JSON, for scripts and to be merged, and as a table.
#pragma once

#include "tools/batch/plan.h"
#include "tools/batch/shard.h"

#include <cstdint>
#include <string>
#include <vector>

namespace acdf::tools {

/// What became of a job.
struct JobResult {
    enum class Status { done, up_to_date, failed };

    std::string input, output, kind;
    Status status = Status::failed;
    std::uint64_t bytes = 0;        ///< of the output; 0 where it failed
    double relative_variance = 0.0; ///< stored in the output
    double seconds = 0.0;           ///< that the job took
    std::string error;              ///< one line; empty where it did not fail
    std::vector<std::string> notes; ///< what a user should know of the source
};

struct BatchReport {
    std::string batch; ///< batch_id() of all shards' jobs
    Shard shard;
    std::vector<JobResult> jobs; ///< in the order of the batch

    std::size_t count(JobResult::Status status) const;
};

/// Indented, with a line end. Bytes that are no UTF-8 become U+FFFD.
std::string to_json(const BatchReport& report);

/// Throws std::invalid_argument where `text` is no report.
BatchReport parse_report(const std::string& text);

struct MergedReport {
    BatchReport report;                ///< jobs by output
    std::vector<std::string> problems; ///< "shard 3/8 has no report": a line each
};

/// Of two reports on the same shard the later counts. Throws std::invalid_argument where they are of different
/// batches, or there are none.
MergedReport merge_reports(const std::vector<BatchReport>& reports);

/// The error of a job; where it names an option of the job's command, also how that is written for a batch.
std::string told_in_batch(const JobResult& job);

/// Errors "NAME: what" of the same `what` as one line that names the first few, in the order of the first of each.
std::vector<std::string> grouped(const std::vector<std::string>& errors);

/// What conversions remarked, a line for each kind of remark: those that differ by their numbers alone are one,
/// which names the first few sources and has the numbers of the first.
std::vector<std::string> remarks(const std::vector<JobResult>& jobs);

/// A row for each of up to 60 files, one for each kind, and one for all of more than one; then the remarks.
std::string summary_table(const BatchReport& report);

} // namespace acdf::tools
