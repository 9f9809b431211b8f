// The kinds of files that are compared under a probe: how each is made, and what it asks of a renderer.
#pragma once

#include "tools/sweep/build.h"

#include <string>
#include <vector>

namespace acdf::tools {

struct FileKind {
    const char* name;    ///< in SweepOptions::files
    const char* command; ///< "env", "local"
    const char* options; ///< "--mis mean", beside a size
    Given needs;
    bool needs_mis;
    std::vector<std::uint64_t> budgets; ///< where none are given
};

/// All of them, in the order of the report.
const std::vector<FileKind>& file_kinds();
const FileKind& file_kind(const std::string& name);
/// Names of those to compare where none are given: visibility with a mesh alone.
std::vector<std::string> default_files(bool mesh);

/// Makes the file of a step; `mesh`: of visibility.
Candidate make_file(const Step& step, const builder::Target& target, const builder::Source& source,
                    const SweptMesh* mesh, AcdfHeuristic heuristic);

} // namespace acdf::tools
