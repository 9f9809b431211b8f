// The files of a probe: one, or six faces of a cube.
#pragma once

#include <functional>
#include <string>
#include <vector>

namespace acdf::input {

/// A source as it is named in one text: a file, or six with commas between them, unless a file has that very name.
std::vector<std::string> probe_files(const std::string& source);

/// What files of the probe are called, without their folders.
std::string probe_name(const std::string& source);

/// Of the file's bytes; of six the digest of their digests, a line each. Throws Error.
std::string probe_sha256(const std::string& source);

/// The same source with the path of each file changed.
std::string with_paths(const std::string& source, const std::function<std::string(const std::string&)>& change);

} // namespace acdf::input
