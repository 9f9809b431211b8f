// What `acdf batch` is asked to make: jobs from folders, globs, files and manifests, checked before any starts.
#pragma once

#include "tools/batch/manifest.h"

#include <cstdint>
#include <string>
#include <vector>

namespace acdf::tools {

/// One source to one file.
struct BatchJob {
    std::string origin; ///< whose fault it is: "library.jsonl:12", or the source
    const JobKind* kind = nullptr;
    std::string source;            ///< a path or, for BRDFs, a model
    std::vector<std::string> maps; ///< of a file of several maps all their paths, `source` the first; else empty
    std::vector<std::string> options;
    std::string base;        ///< the folder that paths among the options are relative to; empty: where we are
    std::string output;      ///< below the output folder, normalized
    std::uint64_t bytes = 0; ///< of the source

    /// All files of the source; none of a model.
    std::vector<std::string> files() const;
    /// To balance shards.
    double seconds() const;
};

/// An option for some of the jobs.
struct BatchSetting {
    std::string pattern; ///< of the source, as in a shell but that * also takes /; empty: all
    const JobKind* kind = nullptr;
    std::string option; ///< "--budget=64KiB"
};

/// "[PATTERN:]KIND.OPTION[=VALUE]", such as "env.budget=64KiB" or "angular/*:env.projection=angular". Throws
/// std::invalid_argument.
BatchSetting parse_setting(const std::string& text);

/// What applies to jobs that do not say otherwise.
struct BatchDefaults {
    std::vector<const JobKind*> probe_kinds{find_kind("env")}; ///< what probes become
    std::vector<BatchSetting> settings;                        ///< of two for one option the later counts

    /// Those for a source, by its name below the folder that was searched, or as it was given.
    std::vector<std::string> options(const JobKind& kind, const std::string& source) const;
};

struct BatchJobs {
    std::vector<BatchJob> jobs;
    std::vector<std::string> folders; ///< all that were searched for sources
    std::vector<std::string> files;   ///< the manifests
    std::vector<std::string> errors;  ///< one line each
};

/// `inputs`: folders (all probes and BRDFs in them and below), files, globs, and manifests (*.jsonl, "-").
BatchJobs collect_jobs(const std::vector<std::string>& inputs, const BatchDefaults& defaults);

/// Adds what is wrong with sources and outputs: files that are missing or folders, names that leave `folder` or are
/// no .acdf file, two jobs of one output, an output that is a source. Sets `bytes` and normalizes `output`.
void check_jobs(const std::string& folder, BatchJobs& jobs);

/// What is wrong with the name of an output; empty: nothing.
std::string output_name_error(const std::string& name);

} // namespace acdf::tools
