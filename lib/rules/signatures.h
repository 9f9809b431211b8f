// What a file is that is none of ours.
#pragma once

#include <cstddef>
#include <cstdint>

namespace acdf {

/// Half a sentence: what people pass by mistake, and what transfers do to the magic.
const char* what_is_it(const std::uint8_t* bytes, std::size_t size) noexcept;

} // namespace acdf
