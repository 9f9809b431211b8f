// What the sources of the reader share. Not installed.
#pragma once

#include <cstdint>

// Functions that run once a file and have no long loops: what they take is room, not time.
#if defined(__GNUC__)
#define ACDF_ONCE __attribute__((cold))
#else
#define ACDF_ONCE
#endif

namespace acdf {

using u8 = std::uint8_t;
using u16 = std::uint16_t;
using u32 = std::uint32_t;
using u64 = std::uint64_t;
using ull = unsigned long long; // for write_message

} // namespace acdf
