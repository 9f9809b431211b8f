// What files say of where they came from.
#pragma once

#include <string>

namespace acdf::input {

/// The name of a file without its folders, for metadata, which is UTF-8: a byte that is none becomes U+FFFD.
std::string file_name(const std::string& path);

/// Throws Error unless `path` is a file with an end: folders, pipes and devices are refused, as is what is not
/// there, and what stands for another file (stand_in.h). `give`: what to give instead, such as "an image file".
void require_regular_file(const std::string& path, const char* give);

/// The letters A to Z of a text made small, whatever the locale.
std::string lower(std::string text);

/// What follows the last dot of the name, with it, in small letters; empty where there is none.
std::string lower_extension(const std::string& path);

} // namespace acdf::input
