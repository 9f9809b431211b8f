// Makes the words of acdf/shader/walk.h, acdf/shader/maps.h and acdf/shader/brdf.h.
#pragma once

#include <acdf/allocator.h>
#include <acdf/reader.h>
#include <acdf/views.h>

namespace acdf {

/// The words of an environment, a local environment or a BRDF, in `block`, which the caller gives back. False where
/// there are none: for rows of 4 GiB, for maps that break a rule, and where memory fails.
bool make_walk(const File& file, AcdfBlock& block) noexcept;

} // namespace acdf
