// SHA-256, as 64 hex digits (FIPS 180-4, by OpenSSL).
#pragma once

#include <string>

namespace acdf::input {

/// Of the file's bytes. Throws Error.
std::string file_sha256(const std::string& path);

/// Of a text; `path` is named where OpenSSL refuses. Throws Error.
std::string text_sha256(const std::string& text, const std::string& path);

} // namespace acdf::input
