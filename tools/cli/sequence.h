// Sequences of files: sky.####.exr, where a # stands for a digit; what several maps together are.
#pragma once

#include <string>
#include <vector>

namespace acdf::tools {

/// One file of a sequence, and its number.
struct Frame {
    long long number = 0;
    std::string file;
};

/// Whether the name has a #, and no file has this name itself.
bool is_sequence(const std::string& source);

/// The files that a sequence stands for, in the order of their numbers. Throws Failure where there are none.
std::vector<Frame> frames_of(const std::string& sequence);

/// The source.sha256 of a file of several maps, of those of all. `path`: for messages.
std::string sha256_of_maps(const std::vector<std::string>& digests, const std::string& path);

} // namespace acdf::tools
