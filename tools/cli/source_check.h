// Whether a file stands for the source that it is measured against.
#pragma once

#include <acdf/reader.h>
#include <acdf/views.h>

#include <cstdint>
#include <string>

namespace acdf::tools {

/// Whether the file records, as metadata `key`, the SHA-256 of another source than one of `sha256`.
bool made_from_another(const File& file, const std::string& sha256, const char* key = "source.sha256");

/// Says so, in one line.
void note_another(const std::string& path, const File& file, const std::string& source, const std::string& sha256,
                  const char* key = "source.sha256");

/// Called once the figures are printed: a file that was made from another source and has no pdf where this one has
/// light does not stand for it. Throws Failure then. A file that misses light of its own source is a figure, no
/// failure: some fits, as published, do.
void require_support(const std::string& path, const File& file, const std::string& source,
                     const std::string& sha256, std::uint64_t violations);

} // namespace acdf::tools
