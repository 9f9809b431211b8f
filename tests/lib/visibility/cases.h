// Files of kind 2 whose cells and portals break one rule each.
#pragma once

#include "tests/lib/reader/check/cases.h"

namespace acdf_test {

std::vector<Case> visibility_cases();
std::vector<Case> portal_cases(); ///< beside visibility cells

} // namespace acdf_test
