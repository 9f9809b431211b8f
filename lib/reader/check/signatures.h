// What a file is that is none of ours. Not installed.
#pragma once

#include <cstdint>

namespace acdf {

/// Half a sentence: what people pass by mistake, and what transfers do to the magic.
const char* what_is_it(const std::uint8_t* bytes, std::uint64_t size) noexcept;

} // namespace acdf
