// The manifest of `acdf batch`: JSON lines, each a job (docs/farm.md).
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace acdf::tools {

/// A kind of file that jobs make.
struct JobKind {
    const char* name;    ///< of the subcommand, too
    const char* suffix;  ///< of outputs without a name: "sky.exr" becomes "sky" + suffix
    double seconds;      ///< to balance shards: of a job with a source of no bytes, about
    double seconds_each; ///< more for each byte of the source
};
// Seconds on one core at the default options; only their ratios matter.
inline constexpr JobKind job_kinds[] = {
    {"env", ".acdf", 0.1, 2e-7}, {"local", ".local.acdf", 2.0, 1e-6}, {"brdf", ".acdf", 4.0, 1e-8}};

/// Null: there is none of this name.
const JobKind* find_kind(std::string_view name);

/// One line. Members that it leaves out are null or empty.
struct ManifestJob {
    std::size_t line = 0; ///< from 1
    std::string source;
    std::vector<std::string> maps; ///< files and sequences, for one file of several maps
    const JobKind* kind = nullptr;
    std::optional<std::vector<std::string>> options; ///< as on a command line
    std::string output;
};

struct ManifestError {
    std::size_t line = 0;
    std::string what;
};

struct Manifest {
    std::vector<ManifestJob> jobs;
    std::vector<ManifestError> errors; ///< at most one a line
};

/// Parses any bytes. Lines of white space alone are skipped. Checks all that needs the text alone: JSON, UTF-8,
/// keys, types; not names, options and files.
Manifest parse_manifest(std::string_view text);

/// Offset of the first byte that is not UTF-8; npos where all are.
std::size_t find_non_utf8(std::string_view text);

} // namespace acdf::tools
