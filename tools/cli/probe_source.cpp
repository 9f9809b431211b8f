#include "tools/cli/probe_source.h"
#include "tools/cli/messages.h"
#include "tools/cli/source_check.h"

#include "build/errors.h"
#include "input/probe/source.h"
#include "tools/commands.h"

#include <algorithm>
#include <cstdio>
#include <stdexcept>

namespace acdf::tools {

builder::Source source_of(const input::Probe& probe, const input::ProbeOptions& options) {
    return {probe.source_name, probe.source_sha256, input::to_string(probe.projection), reading_text(options)};
}

std::string reading_text(const input::ProbeOptions& options) {
    std::string text;
    if (options.projection != input::Projection::automatic)
        text += std::string("--projection ") + input::to_string(options.projection) + " ";
    if (options.faces) text += "--faces " + options.faces->name + " ";
    if (options.domain != input::Domain::source)
        text += std::string("--domain ") + (options.domain == input::Domain::latlong ? "latlong " : "octahedral ");
    if (options.bad_pixels == build::BadPixels::clamp) text += "--bad-pixels clamp ";
    return options.uniform_if_black ? text + "--on-black uniform " : text;
}

namespace {

std::string counts(const build::BadTexels& bad) {
    return std::to_string(bad.nan) + " NaN, " + std::to_string(bad.infinite) + " infinite and " +
           std::to_string(bad.negative) + " negative";
}

/// What `make` makes of a probe, unless that has no energy, or more than floats hold. `make` may read it.
template <class Make>
builder::Target lit(const std::string& path, const input::Probe& probe, const Make& make) {
    try {
        return make();
    } catch (const build::NoEnergy&) {
        const build::BadTexels& bad = probe.bad;
        const std::string repaired = bad.count() == 0 ? "" : " once " + counts(bad) + " texels are repaired";
        throw Failure(path + ": the probe is black in the channels asked for" + repaired +
                      ", so there is nothing to sample; is it the right file or layer? (a probe that is black in "
                      "all channels is accepted with --on-black uniform)");
    } catch (const std::invalid_argument& error) {
        throw Failure(path + ": " + error.what());
    }
}

/// A sun that is more than its file can hold is infinite there, and all of the light may be in it.
std::string advice_on(const build::BadTexels& bad, const input::ProbeOptions& options) {
    return bad.infinite > 0 && options.bad_pixels == build::BadPixels::zero
               ? "; --bad-pixels clamp keeps the light of the infinite ones"
               : "";
}

/// `grid`: what the probe was resampled to; empty where it was not.
void tell(const input::Probe& probe, const input::ProbeOptions& options, const std::string& grid,
          const Note& note) {
    const auto size = [](int width, int height) { return std::to_string(width) + "x" + std::to_string(height); };
    if (!grid.empty() || options.projection == input::Projection::automatic)
        note(std::string(input::to_string(probe.projection)) + " (" + probe.projection_reason + "), " +
             size(probe.source_width, probe.source_height) +
             (grid.empty() ? "" : ", resampled to a " + size(probe.width, probe.height) + " " + grid + " map"));
    const build::BadTexels& bad = probe.bad;
    if (bad.count() > 0)
        note(counts(bad) + " texels " + (options.bad_pixels == build::BadPixels::clamp ? "clamped" : "set to 0") +
             ", the first at " + std::to_string(bad.x) + "," + std::to_string(bad.y) + advice_on(bad, options));
    for (const std::string& warning : probe.warnings) note(warning);
}

} // namespace

Note notes_of(const std::string& path, bool quiet) {
    return [path, quiet](const std::string& text) {
        if (!quiet) say(path + ": " + text);
    };
}

builder::Target probe_texels(const std::string& path, const input::Probe& probe) {
    builder::TargetOptions options;
    options.filter = ACDF_FILTER_NEAREST;
    return lit(path, probe, [&] {
        builder::TargetRows rows(options);
        if (probe.luminance) rows.set_luminance(*probe.luminance);
        rows.begin(probe.width, probe.height);
        rows.take(0, probe.height, probe.rgb.data());
        return rows.finish();
    });
}

input::Probe load_probe(const std::string& path, const input::ProbeOptions& options, bool quiet) {
    input::Probe probe = input::read_probe(path, options);
    tell(probe, options, probe.projection == input::Projection::latlong ? "" : "lat-long", notes_of(path, quiet));
    return probe;
}

namespace {

/// `finish` returns the target of the rows.
ProbeTarget load(const std::string& path, const input::ProbeOptions& options, build::ProbeRows& rows,
                 const std::function<builder::Target()>& finish, const Note& note) {
    ProbeTarget out;
    out.target = lit(path, out.probe, [&] {
        out.probe = input::read_probe(path, options, rows);
        return finish();
    });
    const builder::Target::Data& made = *out.target.data();
    out.error = made.error;
    out.resampled = made.resampled();
    out.probe.width = static_cast<int>(made.grid.columns);
    out.probe.height = static_cast<int>(made.grid.rows);
    const bool square = made.grid.parameterization == ACDF_PARAM_OCTAHEDRAL;
    tell(out.probe, options, !out.resampled ? "" : square ? "octahedral" : "lat-long", note);
    return out;
}

ProbeTarget load(const std::string& path, const input::ProbeOptions& options, builder::TargetRows rows,
                 const Note& note) {
    return load(
        path, options, rows, [&] { return rows.finish(); }, note);
}

ProbeTarget load(const std::string& path, const input::ProbeOptions& options, builder::IndexedMapRows rows,
                 const Note& note, builder::Target& texels) {
    const auto finish = [&] {
        builder::IndexedMap map = rows.finish();
        texels = std::move(map.texels);
        return std::move(map.fitted);
    };
    return load(path, options, rows, finish, note);
}

} // namespace

ProbeTarget load_target(const std::string& path, const input::ProbeOptions& options,
                        const builder::TargetOptions& target_options, const Note& note) {
    builder::TargetOptions chosen = target_options;
    chosen.domain = options.domain;
    return load(path, options, builder::TargetRows(chosen), note);
}

ProbeTarget load_map(const std::string& path, const input::ProbeOptions& options,
                     const builder::TargetOptions& target_options, const Note& note, builder::Target& texels) {
    builder::TargetOptions chosen = target_options;
    chosen.domain = options.domain;
    return load(path, options, builder::IndexedMapRows(chosen), note, texels);
}

namespace {

/// Whether `option` stands among those that a file was made with.
bool made_with(const File& file, const std::string& option) {
    const Text text = file.metadata("fit.options");
    return (std::string(text.data, text.size) + " ").find(option + " ") != std::string::npos;
}

} // namespace

builder::TargetOptions stored_options(const File& file, std::optional<AcdfFilter> filter) {
    const AcdfDescription& d = file.description();
    builder::TargetOptions out;
    out.channels = {static_cast<AcdfChannels>(d.channels),
                    {d.channel_weights[0], d.channel_weights[1], d.channel_weights[2]}};
    out.filter = filter.value_or(static_cast<AcdfFilter>(d.filter));
    if (made_with(file, "--wrap repeat")) out.wrap = builder::Wrap::repeat;
    return out;
}

namespace {

std::string metadata_of(const File& file, const char* key) {
    const Text text = file.metadata(key);
    return {text.data, text.size};
}

/// The projection that had to be given when a file was made; else `automatic`.
input::Projection projection_as_made(const File& file) {
    using Projection = input::Projection;
    for (const Projection given : {Projection::latlong, Projection::angular, Projection::mirrorball,
                                   Projection::cube_cross, Projection::octahedral})
        if (made_with(file, std::string("--projection ") + input::to_string(given))) return given;
    return Projection::automatic;
}

/// How the faces of a source were ordered when a file was made of it; none where they were not.
std::optional<input::Faces> faces_as_made(const File& file) {
    const std::string options = metadata_of(file, "fit.options") + " ", option = "--faces ";
    const std::size_t at = options.find(option);
    if (at == std::string::npos) return {};
    const std::size_t begin = at + option.size();
    input::Faces faces;
    if (!input::parse_faces(options.substr(begin, options.find(' ', begin) - begin), faces)) return {};
    return faces;
}

/// What need not be given again of the very source that a file was made of.
input::ProbeOptions options_as_made(const input::ProbeOptions& given, const File& file, const std::string& source) {
    if (given.projection != input::Projection::automatic || given.faces) return given;
    input::ProbeOptions options = given;
    options.projection = projection_as_made(file);
    options.faces = faces_as_made(file);
    options.squares_are_octahedral =
        metadata_of(file, "source.projection") == input::to_string(input::Projection::octahedral);
    const bool any =
        options.projection != input::Projection::automatic || options.faces || options.squares_are_octahedral;
    return any && made_from_another(file, input::probe_sha256(source)) ? given : options;
}

} // namespace

namespace {

build::Domain grid_of(const File& file) {
    return {static_cast<AcdfParameterization>(file.description().parameterization), file.axis(0).resolution,
            file.axis(1).resolution};
}

} // namespace

ProbeTarget source_target(const std::string& path, const File& file, const std::string& source,
                          const input::ProbeOptions& given, bool quiet, std::optional<AcdfFilter> filter) {
    ProbeTarget out =
        load(source, options_as_made(given, file, source),
             builder::TargetRows(stored_options(file, filter), {}, grid_of(file)), notes_of(source, quiet));
    if (!quiet) note_another(path, file, source, out.probe.source_sha256);
    return out;
}

ProbeTarget source_map(const File& file, const std::string& source, const input::ProbeOptions& given,
                       std::optional<AcdfFilter> filter, builder::Target& texels) {
    return load(source, options_as_made(given, file, source),
                builder::IndexedMapRows(stored_options(file, filter), {}, grid_of(file)), notes_of(source, true),
                texels);
}

ProbeTarget latlong_target(const File& file, const std::string& source, const input::ProbeOptions& given,
                           std::optional<AcdfFilter> filter) {
    input::ProbeOptions options = options_as_made(given, file, source);
    options.domain = input::Domain::latlong;
    return load_target(source, options, stored_options(file, filter), notes_of(source, true));
}

std::string resampling_warning(const ProbeTarget& target, double least_variance, double relative_variance) {
    if (!target.resampled || !(least_variance > 0.5 * relative_variance)) return {};
    char text[200];
    std::snprintf(text, sizeof text,
                  "resampling is the larger part of the noise (%.3g of %.3g): make the file from the map that the "
                  "renderer looks up",
                  least_variance, relative_variance);
    return text;
}

} // namespace acdf::tools
