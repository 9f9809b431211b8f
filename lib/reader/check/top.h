// The top of a tree of halvings, where rows have codes of their own. Not installed.
#pragma once

#include "check/bits.h"

namespace acdf {

constexpr u32 most_open_halvings = 128; // nodes that wait: a level of each axis, and one

/// `bits` has one for each halving: 1 where rows have codes of their own. `count` halvings must, and each that is
/// halved above one of them. False where that is not so, or bits follow that are not 0.
bool check_top(Bits& bits, u32 count, Report& report, const Parts& parts) noexcept;

} // namespace acdf
