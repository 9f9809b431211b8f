// What measuring against a source that a file does not stand for comes to.
#pragma once

#include "tools/cli/file_input.h"
#include "tools/commands.h"

#include <acdf/reader.h>

#include <cstdint>
#include <string>

namespace acdf::tools {

/// Once the figures are told: a file that was made from another source (its SHA-256 differs) and has no density
/// where this one has light does not stand for it. Throws Failure then. A file that misses light of its own source
/// is a figure, no failure: some fits, as published, do.
inline void require_support(const std::string& path, const File& file, const std::string& source,
                            const std::string& sha256, std::uint64_t violations) {
    const Text hash = file.metadata("source.sha256");
    if (violations == 0 || hash.size == 0 || std::string(hash.data, hash.size) == sha256) return;
    throw Failure(path + ": does not stand for " + source +
                  ": it was made from another file, and its density is 0 in " + std::to_string(violations) +
                  " places where that has light; measure against its own source");
}

} // namespace acdf::tools
