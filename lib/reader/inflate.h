// What is stored deflated, and CRCs: by zlib, where ACDF_ZLIB is not 0. Not installed.
#pragma once

#include <cstdint>

#ifndef ACDF_ZLIB
#define ACDF_ZLIB 1
#endif

namespace acdf {

/// CRC-32 of what `seed` is that of and `size` bytes behind it; of nothing it is 0.
std::uint32_t crc32_of(std::uint32_t seed, const std::uint8_t* bytes, std::uint64_t size) noexcept;

/// Inflates a whole zlib stream to exactly `size` bytes; null, or what is wrong.
const char* inflate(const std::uint8_t* in, std::uint64_t in_size, std::uint8_t* out, std::uint64_t size) noexcept;
/// The same to at most `out_size` bytes, and sets that to how many.
const char* inflate_within(const std::uint8_t* in, std::uint64_t in_size, std::uint8_t* out,
                           std::uint64_t& out_size) noexcept;

} // namespace acdf
