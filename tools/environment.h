// From a probe to the bytes of an environment file: target, fit, cascade, file, and its exact accuracy.
#pragma once

#include "compress/fit.h"
#include "compress/store.h"
#include "input/probe.h"
#include "measure/accuracy.h"
#include "progress.h"

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace acdf::tools {

/// What `acdf env` was asked for, beside the probe.
struct EnvironmentOptions {
    compress::TargetOptions target;
    compress::FitOptions fit; ///< without an order, fits of two levels are made both ways, the better one kept
    AcdfCodec codec = ACDF_CODEC_NONE;
};

struct Environment {
    std::vector<std::uint8_t> bytes;      ///< the whole file
    measure::Accuracy accuracy;           ///< of the stored density, after quantization
    std::optional<compress::Order> order; ///< which axis was split first, where that was tried or asked for
};

/// Where a probe came from, for the metadata.
struct Source {
    std::string name, sha256, projection;
    std::string reading = {}; ///< how it was read: see reading_text
};

/// What was made of a probe, for the metadata.
Source source_of(const input::Probe& probe, const input::ProbeOptions& options);

/// Options of reading in one spelling (option_text.h): "--projection angular ", or empty.
std::string reading_text(const input::ProbeOptions& options);

/// All options that shape the file, in one spelling: what its `fit.options` tells.
std::string option_text(const std::string& reading, const EnvironmentOptions& options);

/// Throws std::invalid_argument where the target has no energy, std::runtime_error where the goal is out of reach.
Environment build_environment(const compress::Target& target, const Source& source,
                              const EnvironmentOptions& options, const Progress& progress = {});

/// The target of a probe. Throws Failure, naming `path`, where it has no energy.
compress::Target probe_target(const std::string& path, const input::Probe& probe,
                              const compress::TargetOptions& options = {});

/// Called with what a user should know of a source: one line without a file's name.
using Note = std::function<void(const std::string&)>;

/// A probe without its pixels, and what is fitted of it.
struct ProbeTarget {
    input::Probe probe;
    compress::Target target;
};

/// Reads a probe in bands of rows and tells what was assumed and what was mended: memory holds the target, four
/// bytes a texel for one channel with nearest lookup, but for probes that are no lat-long maps. Throws
/// input::Error, and Failure where it has no energy.
ProbeTarget load_target(const std::string& path, const input::ProbeOptions& options,
                        const compress::TargetOptions& target_options, const Note& note);

/// Reads a probe, and tells the same on stderr unless `quiet`. Throws input::Error.
input::Probe load_probe(const std::string& path, const input::ProbeOptions& options, bool quiet);

/// The target that a file was fitted to, from its source: what it says of channels and filter. Tells on stderr,
/// unless `quiet`, where the source is another file than it was made from. Throws Failure where the resolution is
/// another.
compress::Target source_target(const std::string& path, const File& file, const std::string& source,
                               const input::ProbeOptions& options, bool quiet);

/// "phi" or "z".
const char* to_string(compress::Order order);

} // namespace acdf::tools
