// What outputs are called: beside their inputs where no name is given, and in a folder where there are several.
#pragma once

#include <string>
#include <vector>

namespace acdf::tools {

/// "skies/sky.exr" as "skies/sky" + `suffix` (".acdf", ".local.acdf"); the model of a BRDF as itself + `suffix`.
std::string output_beside(const std::string& input, const std::string& suffix);

/// The names of the outputs of `inputs`, as `output` (-o) has it: beside each input where it is empty; in it where
/// it is a folder (it exists as one, or ends in /), or where there are several inputs; else the file itself, or
/// "-". The last extension of `suffix` is the only one that a file may have. Throws CLI::ValidationError for
/// another, and where two inputs would have the same output; Failure where an input without a name for its output
/// ends as outputs do.
std::vector<std::string> output_names(const std::vector<std::string>& inputs, const std::string& output,
                                      const std::string& suffix);

} // namespace acdf::tools
