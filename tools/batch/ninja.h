// A batch as a build file of Ninja.
#pragma once

#include "tools/batch/plan.h"

#include <cstdint>
#include <string>
#include <vector>

namespace acdf::tools {

struct NinjaBuild {
    std::string program;                   ///< path of acdf
    std::string output;                    ///< folder of outputs, and of the build file
    std::string folder;                    ///< the current one, which `command` is relative to
    std::vector<std::string> command;      ///< arguments of acdf that made this build file
    std::vector<std::string> dependencies; ///< what the list of jobs depends on: manifests, folders; absolute
    std::uint64_t memory = 0;              ///< for all jobs at once
    int threads = 1;                       ///< jobs at once
};

/// The first line of every build file made here.
extern const char ninja_mark[];

/// The text of build.ninja, to lie in the output folder. Each job is an edge that runs the job's own subcommand; it
/// depends on its source and on the files among its options, and Ninja itself compares options. Jobs of which as
/// many as `threads` would not fit into `memory` share a pool. Throws Failure for names with line ends, which Ninja
/// does not take.
std::string ninja_text(const std::vector<PlannedJob>& plan, const NinjaBuild& build, const MakeConversion& make);

} // namespace acdf::tools
