// All rules of the format, for the subcommands.
#pragma once

#include "reader/check/check.h"

#include <cstdint>
#include <functional>
#include <vector>

namespace acdf::tools {

/// Reports the findings of the reader's checks, and where they found no error, those of the rooms beside it. `take`
/// returns false to stop.
Verdict validate_all(const std::vector<std::uint8_t>& bytes, const std::function<bool(const Finding&)>& take);

} // namespace acdf::tools
