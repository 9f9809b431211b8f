// What is stored deflated, and CRCs: by zlib, where ACDF_ZLIB is not 0. Not installed.
#pragma once

#include "sources.h"

#ifndef ACDF_ZLIB
#define ACDF_ZLIB 1
#endif

namespace acdf {

/// CRC-32 of what `seed` is that of and `size` bytes behind it; of nothing it is 0.
u32 crc32_of(u32 seed, const u8* bytes, u64 size) noexcept;

/// Inflates a whole zlib stream to exactly `size` bytes; null, or what is wrong.
const char* inflate(const u8* in, u64 in_size, u8* out, u64 size) noexcept;
/// The same to at most `out_size` bytes, and sets that to how many.
const char* inflate_within(const u8* in, u64 in_size, u8* out, u64& out_size) noexcept;

} // namespace acdf
