// From one source to one file: what `acdf env`, `acdf local` and `acdf brdf` do once and `acdf batch` many times.
#pragma once

#include "input/probe/source.h"
#include "tools/cli/probe_source.h"
#include "tools/cli/progress.h"

#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

namespace CLI {
class App;
}

namespace acdf::tools {

struct Converted {
    std::vector<std::uint8_t> bytes; ///< the whole file
    double relative_variance = 0.0;  ///< stored in the file itself
    std::string report;              ///< for --json, an object: but for the name of the output
    std::string summary;             ///< a line for people: what stands behind the file's size
};

/// Whom a conversion talks to while it works.
struct Listener {
    build::Progress progress;
    Note note;
};

/// A source, a kind of file and its options. Not to be copied: options are bound to its members.
class Conversion {
public:
    Conversion() = default;
    virtual ~Conversion() = default;
    Conversion(const Conversion&) = delete;
    Conversion& operator=(const Conversion&) = delete;

    std::string source; ///< a path, six (lib/input/probe/source.h) or, for BRDFs, a model

    /// Registers the options that shape the file, once. `command` must live as long as this.
    virtual void add_options(CLI::App& command) = 0;

    /// Call once the command line is parsed, before all below. Throws CLI::ValidationError where options contradict
    /// each other.
    virtual void check() = 0;

    /// The paths of all files that are read, `source` among them, for the caller to see and to change.
    virtual std::vector<std::string*> files() { return {&source}; }

    /// The metadata `fit.options` that the file will have. Reads a scene to hash it. Throws input::Error.
    virtual std::string option_text() const = 0;

    /// Bytes of memory that convert() needs, about, from the header of the source alone. 0 where it is not known,
    /// as the source is missing or damaged.
    virtual std::uint64_t memory() const = 0;

    /// How the source is read; null: it is no probe.
    virtual const input::ProbeOptions* reading() const { return nullptr; }

    /// Whether several sources become one file; then they are taken over, and `source` is the first. Call before
    /// check(), and throws as it.
    virtual bool takes_all(const std::vector<std::string>&) { return false; }

    /// Deterministic for any number of threads. Throws Failure or input::Error: one line.
    virtual Converted convert(const Listener& listener) = 0;
};

/// The paths of all files that are read: a source may be six.
inline std::vector<std::string> input_paths(Conversion& conversion) {
    std::vector<std::string> out;
    for (const std::string* file : conversion.files())
        for (const std::string& path : input::probe_files(*file)) out.push_back(path);
    return out;
}

std::unique_ptr<Conversion> env_conversion();
std::unique_ptr<Conversion> local_conversion();
std::unique_ptr<Conversion> brdf_conversion();

/// What a subcommand that converts says of itself.
struct ConversionHelp {
    const char* source; ///< "PROBE"
    const char* suffix; ///< of outputs without a name: of "sky.exr" instead of ".exr"
    const char* source_text;
    std::string footer;
};

/// Makes `command` convert: its sources, -o, the options of the conversion, and those on how to run and report.
void add_conversion(CLI::App& command, std::shared_ptr<Conversion> conversion, const ConversionHelp& help,
                    int& exit_code);

} // namespace acdf::tools
