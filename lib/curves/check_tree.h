// What a chunk TREE is checked for. Not installed.
#pragma once

#include "check/checker.h"

namespace acdf {

/// BINS and TREE; needs parts.description. Sets parts.bins.
void check_tree(const Payload& bins, const Payload& tree, u32 kind, Report& report, Parts& parts) noexcept;

} // namespace acdf
