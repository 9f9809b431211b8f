// Where among the maps of an indexed environment: --at time=9.5.
#pragma once

#include <acdf/reader.h>
#include <acdf/views.h>

#include <string>
#include <vector>

namespace acdf::tools {

/// The names of the indexed axes, in their order.
std::vector<std::string> indexed_axes(const File& file);

/// The environment at the coordinates that --at gave: NAME=VALUE for each axis, or a value each in their order.
/// Throws Failure where one is missing or no number.
MixedEnvironment chosen_environment(const std::string& path, const File& file, const std::vector<std::string>& at);

/// That of the first map.
MixedEnvironment first_environment(const File& file);

} // namespace acdf::tools
