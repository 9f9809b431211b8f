// Reading .acdf files and their bytes for the subcommands.
#pragma once

#include <acdf/indexed/views.h>
#include <acdf/reader.h>
#include <acdf/views.h>

#include <cstdint>
#include <string>
#include <vector>

namespace acdf::tools {

/// All bytes of the file at `path`, or of stdin for "-", but no more than `most`: some inputs never end. Throws
/// Failure.
std::vector<std::uint8_t> read_bytes(const std::string& path, std::uint64_t most = std::uint64_t{1} << 28);

/// The same for an .acdf file: what does not begin like one is not read further, and left to the checks.
std::vector<std::uint8_t> read_acdf_bytes(const std::string& path);

/// Throws Failure where `path` is a folder, a pipe or a device, unless it is "-": before it is opened, which would
/// wait for the writer of a pipe for ever.
void refuse_endless(const std::string& path);

/// Whether bytes begin as an .acdf file does.
bool has_magic(const std::vector<std::uint8_t>& bytes);

/// A checked file and the bytes it lies in.
struct LoadedFile {
    std::vector<std::uint8_t> bytes;
    File file;
    IndexedEnvironment maps; ///< of a file of several; else empty
};

/// Throws Failure, which names the file, the broken rule and what would help.
LoadedFile load_file(const std::string& path);

/// Throws Failure where the bytes of a file just written are not accepted.
void check_reads_back(const std::uint8_t* data, std::size_t size);

/// Throws the Failure that says that `command` reads `wanted`, not a file of this kind.
[[noreturn]] void fail_kind(const std::string& path, const File& file, const char* command, const char* wanted);

/// As load_file, and fails where the file is no environment; `command` is named in the message.
LoadedFile load_environment(const std::string& path, const char* command);
/// The same for environments and tables.
LoadedFile load_environment_or_table(const std::string& path, const char* command);

} // namespace acdf::tools
