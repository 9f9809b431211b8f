// What calls on an environment of several maps need, made once when its view is opened. Not installed.
#pragma once

#include "indexed/check.h"

#include <acdf/indexed/indexed.h>

namespace acdf {

/// The tables of maps that are right, in `block`, which the caller gives back. `parts` are those of their file,
/// `heights` those of its tree. Null where there is no memory. Linear in the file.
AcdfTop* make_top(const Parts& parts, const Maps& maps, const double* heights, const AcdfAllocator& allocator,
                  AcdfBlock& block) noexcept;

} // namespace acdf
