#include "tools/cli/probe_source.h"

#include "build/errors.h"
#include "tools/commands.h"

#include <algorithm>
#include <cstdio>

namespace acdf::tools {

builder::Source source_of(const input::Probe& probe, const input::ProbeOptions& options) {
    return {probe.source_name, probe.source_sha256, input::to_string(probe.projection), reading_text(options)};
}

std::string reading_text(const input::ProbeOptions& options) {
    std::string text;
    if (options.projection != input::Projection::automatic)
        text += std::string("--projection ") + input::to_string(options.projection) + " ";
    if (options.bad_pixels == build::BadPixels::clamp) text += "--bad-pixels clamp ";
    return options.uniform_if_black ? text + "--on-black uniform " : text;
}

namespace {

/// What `make` makes, unless it has no energy.
template <class Make>
builder::Target lit(const std::string& path, const Make& make) {
    try {
        return make();
    } catch (const build::NoEnergy&) {
        throw Failure(path +
                      ": the probe is black in the channels asked for, so there is nothing to sample; is it the "
                      "right file or layer? (what is black in all channels is accepted with --on-black uniform)");
    }
}

void tell(const input::Probe& probe, const input::ProbeOptions& options, const Note& note) {
    const auto size = [](int width, int height) { return std::to_string(width) + "x" + std::to_string(height); };
    const bool resampled = probe.projection != input::Projection::latlong;
    if (resampled || options.projection == input::Projection::automatic)
        note(std::string(input::to_string(probe.projection)) + " (" + probe.projection_reason + "), " +
             size(probe.source_width, probe.source_height) +
             (resampled ? ", resampled to a " + size(probe.width, probe.height) + " lat-long map" : ""));
    const build::BadTexels& bad = probe.bad;
    if (bad.count() > 0)
        note(std::to_string(bad.nan) + " NaN, " + std::to_string(bad.infinite) + " infinite and " +
             std::to_string(bad.negative) + " negative texels " +
             (options.bad_pixels == build::BadPixels::clamp ? "clamped" : "set to 0") + ", the first at " +
             std::to_string(bad.x) + "," + std::to_string(bad.y));
    for (const std::string& warning : probe.warnings) note(warning);
}

Note notes_of(const std::string& path, bool quiet) {
    return [path, quiet](const std::string& text) {
        if (!quiet) std::fprintf(stderr, "%s: %s\n", path.c_str(), text.c_str());
    };
}

} // namespace

builder::Target probe_target(const std::string& path, const input::Probe& probe,
                             const builder::TargetOptions& options) {
    return lit(path, [&] {
        builder::TargetRows rows(options);
        rows.begin(probe.width, probe.height);
        rows.take(0, probe.height, probe.rgb.data());
        return rows.finish();
    });
}

input::Probe load_probe(const std::string& path, const input::ProbeOptions& options, bool quiet) {
    input::Probe probe = input::read_probe(path, options);
    tell(probe, options, notes_of(path, quiet));
    return probe;
}

ProbeTarget load_target(const std::string& path, const input::ProbeOptions& options,
                        const builder::TargetOptions& target_options, const Note& note) {
    builder::TargetRows rows(target_options);
    input::Probe probe = input::read_probe(path, options, rows);
    tell(probe, options, note);
    builder::Target target = lit(path, [&] { return rows.finish(); });
    return {std::move(probe), std::move(target)};
}

builder::Target source_target(const std::string& path, const File& file, const std::string& source,
                              const input::ProbeOptions& options, bool quiet) {
    const AcdfDescription& d = file.description();
    builder::TargetOptions as_stored;
    as_stored.channels = {static_cast<AcdfChannels>(d.channels),
                          {d.channel_weights[0], d.channel_weights[1], d.channel_weights[2]}};
    as_stored.filter = static_cast<AcdfFilter>(d.filter);
    auto [probe, target] = load_target(source, options, as_stored, notes_of(source, quiet));
    const Text hash = file.metadata("source.sha256");
    if (hash.size > 0 && std::string(hash.data, hash.size) != probe.source_sha256 && !quiet)
        std::fprintf(stderr, "%s: made from another file than %s (its SHA-256 differs)\n", path.c_str(),
                     source.c_str());
    const AcdfAxis &phi = file.axis(ACDF_AXIS_PHI), &theta = file.axis(ACDF_AXIS_THETA);
    if (phi.resolution != target.columns() || theta.resolution != target.rows())
        throw Failure(source + ": is " + std::to_string(target.columns()) + "x" + std::to_string(target.rows()) +
                      " as a lat-long map, but " + path + " was made from " + std::to_string(phi.resolution) + "x" +
                      std::to_string(theta.resolution) + "; measure against the source it was made from");
    return target;
}

} // namespace acdf::tools
