// Arrays that a caller holds, as floats.
#pragma once

#include "build/array.h"

#include <acdf/builder.h>

namespace acdf::builder {

/// Throws build::OptionError for what is no array of 1 to 6 axes.
void check(const Array& array);

/// All numbers of an array that was checked, row-major; bad ones are 0, and counted in `bad`.
build::Array to_floats(const Array& array, BadNumbers& bad);

} // namespace acdf::builder
