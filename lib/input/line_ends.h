// Line ends that Git, or a transfer in text mode, converted in files that are no text.
#pragma once

#include <string>

namespace acdf::input {

/// Throws Error where every LF of a binary file follows a CR, `least` or more of them behind its first byte that is
/// no text, or one behind text whose lines end so: two are there by chance in one of 65536 files. Reading ends with
/// the first LF that proves that it is not so.
void refuse_converted_line_ends(const std::string& path, unsigned least = 2);

/// Of a binary file that is shorter than it should be or damaged, to be added to what is wrong: that its CR LF may
/// have become LF, where it has LF but no CR LF; else empty.
std::string maybe_converted_line_ends(const std::string& path);

} // namespace acdf::input
