// Probes as the command line takes them: read, reported, and made into targets.
#pragma once

#include "build/builder/sources.h"
#include "input/probe/probe.h"

#include <acdf/reader.h>
#include <acdf/views.h>

#include <functional>
#include <optional>
#include <string>

namespace acdf::tools {

/// What was made of a probe, for the metadata.
builder::Source source_of(const input::Probe& probe, const input::ProbeOptions& options);

/// Options of reading in one spelling (build/text/options.h): "--projection angular --domain latlong ", or empty.
std::string reading_text(const input::ProbeOptions& options);

/// The texels of a probe, as targets of nearest lookup. Throws Failure, naming `path`, where it has no energy.
builder::Target probe_texels(const std::string& path, const input::Probe& probe);

/// Called with what a user should know of a source: one line without a file's name.
using Note = std::function<void(const std::string&)>;

/// Prints them on stderr, behind the name of a source, unless `quiet`.
Note notes_of(const std::string& path, bool quiet);

/// A probe without its pixels, and what is fitted of it.
struct ProbeTarget {
    input::Probe probe; ///< its width and height are those of the target's grid
    builder::Target target;
    bool resampled = false; ///< the grid is not the source's own
    double error = 0.0;     ///< build::SourceTarget
};

/// Reads a probe, makes its target on the grid that `options.domain` (not that of `target_options`) names, and
/// reports assumptions and repairs. A lat-long probe on its own texels is read in bands of rows: memory holds the
/// target, four bytes a texel for one channel with nearest lookup. Throws Error, and Failure where it has no
/// energy.
ProbeTarget load_target(const std::string& path, const input::ProbeOptions& options,
                        const builder::TargetOptions& target_options, const Note& note);

/// The same of one of several maps for one file; `texels` as well. Throws Failure, too, where it would be
/// resampled.
ProbeTarget load_map(const std::string& path, const input::ProbeOptions& options,
                     const builder::TargetOptions& target_options, const Note& note, builder::Target& texels);

/// Reads a probe, and reports the same on stderr unless `quiet`. Throws Error.
input::Probe load_probe(const std::string& path, const input::ProbeOptions& options, bool quiet);

/// What a file says of channels, filter and wrap. `filter`: of another lookup than the file was made for.
builder::TargetOptions stored_options(const File& file, std::optional<AcdfFilter> filter = {});

/// What a renderer that looks `source` up integrates, on the grid of a file: what that says of channels and filter.
/// The source may have any layout and resolution; the projection or the faces that the file was made with need not
/// be given again where this is its very source. `filter`: as stored_options(). Reports on stderr, unless `quiet`,
/// where it is another file than the file was made from.
ProbeTarget source_target(const std::string& path, const File& file, const std::string& source,
                          const input::ProbeOptions& options, bool quiet, std::optional<AcdfFilter> filter = {});

/// The same without a report, and with the texels themselves (builder::IndexedMap).
ProbeTarget source_map(const File& file, const std::string& source, const input::ProbeOptions& options,
                       std::optional<AcdfFilter> filter, builder::Target& texels);

/// The same on a lat-long grid, whatever the file's.
ProbeTarget latlong_target(const File& file, const std::string& source, const input::ProbeOptions& options,
                           std::optional<AcdfFilter> filter = {});

/// One line where resampling is the larger part of a file's variance; else empty.
std::string resampling_warning(const ProbeTarget& target, double least_variance, double relative_variance);

} // namespace acdf::tools
