// Which vectors the processor has that runs us.
#pragma once

#include <acdf/wavefront.h>

namespace acdf {

/// The best of them.
Instructions instructions_of_this_processor() noexcept;

} // namespace acdf
