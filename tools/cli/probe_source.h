// Probes as the command line takes them: read, told of, and made into targets.
#pragma once

#include "build/builder/sources.h"
#include "input/probe.h"

#include <acdf/reader.h>

#include <functional>
#include <string>

namespace acdf::tools {

/// What was made of a probe, for the metadata.
builder::Source source_of(const input::Probe& probe, const input::ProbeOptions& options);

/// Options of reading in one spelling (option_text.h): "--projection angular ", or empty.
std::string reading_text(const input::ProbeOptions& options);

/// The target of a probe. Throws Failure, naming `path`, where it has no energy.
builder::Target probe_target(const std::string& path, const input::Probe& probe,
                             const builder::TargetOptions& options = {});

/// Called with what a user should know of a source: one line without a file's name.
using Note = std::function<void(const std::string&)>;

/// A probe without its pixels, and what is fitted of it.
struct ProbeTarget {
    input::Probe probe;
    builder::Target target;
};

/// Reads a probe in bands of rows and tells what was assumed and what was mended: memory holds the target, four
/// bytes a texel for one channel with nearest lookup, but for probes that are no lat-long maps. Throws
/// Error, and Failure where it has no energy.
ProbeTarget load_target(const std::string& path, const input::ProbeOptions& options,
                        const builder::TargetOptions& target_options, const Note& note);

/// Reads a probe, and tells the same on stderr unless `quiet`. Throws Error.
input::Probe load_probe(const std::string& path, const input::ProbeOptions& options, bool quiet);

/// The target that a file was fitted to, from its source: what it says of channels and filter. Tells on stderr,
/// unless `quiet`, where the source is another file than it was made from. Throws Failure where the resolution is
/// another.
builder::Target source_target(const std::string& path, const File& file, const std::string& source,
                              const input::ProbeOptions& options, bool quiet);

} // namespace acdf::tools
