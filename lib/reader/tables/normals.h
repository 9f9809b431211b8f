// What calls on a local environment on one tree of halvings need, made once when its file is opened. Not installed.
#pragma once

#include "check/check.h"

#include <acdf/normal_rows.h>

namespace acdf {

/// The tables of the file of `parts`, in `block`, which the caller gives back; null where there is no memory.
/// `lookup`: whether a lookup grid is made. `heights`: those of the rows of a lat-long grid. Linear in rows times
/// splits.
AcdfNormalRows* make_normal_rows(const Parts& parts, bool lookup, const double* heights,
                                 const AcdfAllocator& allocator, AcdfBlock& block) noexcept;

} // namespace acdf
