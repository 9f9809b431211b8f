// Texts of errors: the part of printf that the reader needs. Not installed.
#pragma once

#include "sources.h"

#include <cstdarg>
#include <cstddef>

namespace acdf {

/// Writes as much as `out` has room for, terminated: %s, %u, %x, %llu, with a width in zeros (%08x). The same text
/// in every locale, without the streams of a C library.
ACDF_ONCE void write_message(char* out, std::size_t size, const char* format, std::va_list arguments) noexcept;
#if defined(__GNUC__)
__attribute__((format(printf, 3, 4)))
#endif
ACDF_ONCE void
write_message(char* out, std::size_t size, const char* format, ...) noexcept;

} // namespace acdf
