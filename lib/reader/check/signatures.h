// What a file is that is none of ours. Not installed.
#pragma once

#include "sources.h"

namespace acdf {

/// Half a sentence: what people pass by mistake, and what transfers do to the magic.
const char* what_is_it(const u8* bytes, u64 size) noexcept;

} // namespace acdf
