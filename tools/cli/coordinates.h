// Where among the maps of an indexed environment: --at time=9.5.
#pragma once

#include "tools/cli/file_input.h"

#include <acdf/indexed/views.h>

#include <string>
#include <vector>

namespace acdf::tools {

/// The names of the indexed axes, in their order.
std::vector<std::string> indexed_axes(const File& file);

/// The environment at the coordinates that --at gave: NAME=VALUE for each axis, or a value each in their order.
/// Throws Failure where one is missing or no number. The file is at `path`, and must outlive it.
MixedEnvironment chosen_environment(const std::string& path, const LoadedFile& loaded,
                                    const std::vector<std::string>& at);

/// That of the first map.
MixedEnvironment first_environment(const IndexedEnvironment& maps);

} // namespace acdf::tools
