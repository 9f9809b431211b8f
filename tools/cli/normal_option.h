// --normal: for which surface a local environment is asked.
#pragma once

#include "tools/cli/comma_list.h"
#include "tools/commands.h"
#include "tools/plot/local.h"

#include <acdf/local.h>

#include <CLI/CLI.hpp>

#include <string>
#include <vector>

namespace acdf::tools {

inline CLI::Option* add_normal(CLI::App& command, std::vector<float>& normal, const char* group,
                               const char* remark = "") {
    return comma_separated(
               command.add_option(
                   "--normal", normal,
                   std::string("For a local environment, the normal of the surface, of any length (0,0,1 is up)") +
                       remark),
               3)
        ->option_text("X,Y,Z")
        ->group(group);
}

/// The normal that --normal gave. Throws Failure where it has no direction.
inline Normal chosen_normal(const std::string& path, const std::vector<float>& normal) {
    if (normal.empty()) throw Failure(path + ": is a local environment; choose a normal with --normal X,Y,Z");
    AcdfNormalBins bins;
    if (!acdf_octahedral_bins(1, normal.data(), &bins))
        throw Failure(path + ": the normal of --normal is zero or not finite");
    return {normal[0], normal[1], normal[2]};
}

inline void refuse_normal(const std::string& path, const std::vector<float>& normal) {
    if (!normal.empty()) throw Failure(path + ": is not a local environment; leave out --normal");
}

} // namespace acdf::tools
