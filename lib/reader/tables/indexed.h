// What calls on an indexed environment need, made once when its file is opened. Not installed.
#pragma once

#include "check/check.h"

#include <acdf/indexed.h>

namespace acdf {

/// `lookup`: whether a lookup grid is made. The view of the file of `parts`, whose tables lie in `block`, which the
/// caller gives back; `top` is null where there is no memory. Linear in the file.
AcdfIndexed make_indexed(const Parts& parts, bool lookup, const AcdfAllocator& allocator,
                         AcdfBlock& block) noexcept;

} // namespace acdf
