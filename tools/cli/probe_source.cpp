#include "tools/cli/probe_source.h"

#include "build/option_text.h"
#include "tools/commands.h"

#include <algorithm>
#include <cstdio>
#include <optional>
#include <vector>

namespace acdf::tools {

build::Source source_of(const input::Probe& probe, const input::ProbeOptions& options) {
    return {probe.source_name, probe.source_sha256, input::to_string(probe.projection), reading_text(options)};
}

std::string reading_text(const input::ProbeOptions& options) {
    std::string text;
    if (options.projection != input::Projection::automatic)
        text += std::string("--projection ") + input::to_string(options.projection) + " ";
    if (options.domain != input::Domain::source)
        text += std::string("--domain ") + (options.domain == input::Domain::latlong ? "latlong " : "octahedral ");
    if (options.bad_pixels == build::BadPixels::clamp) text += "--bad-pixels clamp ";
    return options.uniform_if_black ? text + "--on-black uniform " : text;
}

namespace {

/// A probe on its way into a target, on a grid that was told or is chosen.
class TargetRows : public input::ProbeRows {
public:
    TargetRows(const compress::TargetOptions& options, input::Domain domain, std::optional<build::Domain> grid = {})
        : options_(options), domain_(domain), grid_(grid) {}

    bool take_map(const build::Map& map, const std::vector<float>& rgb) override {
        result_ = target_of(map, rgb.data());
        return true;
    }
    void begin(int width, int height) override {
        map_ = {build::Layout::latlong, width, height};
        if (own_texels(map_)) {
            compress::TargetOptions options = options_;
            options.parameterization = ACDF_PARAM_LATLONG;
            target_.emplace(static_cast<std::uint32_t>(width), static_cast<std::uint32_t>(height), options);
        } else {
            rgb_.resize(row() * static_cast<std::size_t>(height));
        }
    }
    void take(int first, int count, const float* rgb) override {
        if (target_) target_->take(static_cast<std::uint32_t>(first), static_cast<std::uint32_t>(count), rgb);
        else
            std::copy_n(rgb, row() * static_cast<std::size_t>(count),
                        rgb_.begin() + static_cast<std::ptrdiff_t>(row() * static_cast<std::size_t>(first)));
    }
    build::SourceTarget finish() {
        if (target_) return {target_->finish(), 0.0};
        return rgb_.empty() ? std::move(result_) : target_of(map_, rgb_.data());
    }

private:
    std::size_t row() const { return std::size_t{3} * static_cast<std::size_t>(map_.width); }

    /// The grid, where it does not depend on what would be lost.
    std::optional<build::Domain> grid_of(const build::Map& map) const {
        if (grid_) return grid_;
        switch (domain_) {
        case input::Domain::latlong:
            return build::domain_for(map, ACDF_PARAM_LATLONG);
        case input::Domain::octahedral:
            return build::domain_for(map, ACDF_PARAM_OCTAHEDRAL);
        default:
            return build::own_domain(map);
        }
    }
    bool own_texels(const build::Map& map) const {
        const auto grid = grid_of(map), own = build::own_domain(map);
        return grid && own && *grid == *own;
    }
    build::SourceTarget target_of(const build::Map& map, const float* rgb) const {
        const auto grid = grid_of(map);
        return grid ? build::source_target(map, rgb, *grid, options_)
                    : build::source_target_losing_least(map, rgb, options_);
    }

    compress::TargetOptions options_;
    input::Domain domain_;
    std::optional<build::Domain> grid_;
    build::Map map_;
    std::vector<float> rgb_;
    std::optional<compress::EnvironmentTarget> target_;
    build::SourceTarget result_;
};

compress::Target lit(const std::string& path, compress::Target target) {
    if (!(compress::integral(target) > 0.0))
        throw Failure(path +
                      ": the probe is black in the channels asked for, so there is nothing to sample; is it the "
                      "right file or layer? (what is black in all channels is accepted with --on-black uniform)");
    return target;
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

compress::Target probe_target(const std::string& path, const input::Probe& probe,
                              const compress::TargetOptions& options) {
    return lit(path, compress::environment_target(probe.rgb.data(), static_cast<std::uint32_t>(probe.width),
                                                  static_cast<std::uint32_t>(probe.height), options));
}

input::Probe load_probe(const std::string& path, const input::ProbeOptions& options, bool quiet) {
    input::Probe probe = input::read_probe(path, options);
    tell(probe, options, probe.projection == input::Projection::latlong ? "" : "lat-long", notes_of(path, quiet));
    return probe;
}

namespace {

ProbeTarget load(const std::string& path, const input::ProbeOptions& options, TargetRows rows, const Note& note) {
    ProbeTarget out;
    out.probe = input::read_probe(path, options, rows);
    build::SourceTarget made = rows.finish();
    out.error = made.error;
    out.target = lit(path, std::move(made.target));
    out.probe.width = static_cast<int>(out.target.columns);
    out.probe.height = static_cast<int>(out.target.rows);
    const auto own = build::own_domain(out.probe.source_map);
    out.resampled =
        !own || !(*own == build::Domain{out.target.parameterization, out.target.columns, out.target.rows});
    const bool square = out.target.parameterization == ACDF_PARAM_OCTAHEDRAL;
    tell(out.probe, options, !out.resampled ? "" : square ? "octahedral" : "lat-long", note);
    return out;
}

} // namespace

ProbeTarget load_target(const std::string& path, const input::ProbeOptions& options,
                        const compress::TargetOptions& target_options, const Note& note) {
    return load(path, options, TargetRows(target_options, options.domain), note);
}

ProbeTarget source_target(const std::string& path, const File& file, const std::string& source,
                          const input::ProbeOptions& options, bool quiet) {
    const AcdfDescription& d = file.description();
    const compress::TargetOptions target{{d.channel_weights[0], d.channel_weights[1], d.channel_weights[2]},
                                         static_cast<AcdfChannels>(d.channels),
                                         static_cast<AcdfFilter>(d.filter),
                                         static_cast<AcdfParameterization>(d.parameterization)};
    const build::Domain grid{target.parameterization, file.axis(0).resolution, file.axis(1).resolution};
    ProbeTarget out = load(source, options, TargetRows(target, options.domain, grid), notes_of(source, quiet));
    const Text hash = file.metadata("source.sha256");
    if (hash.size > 0 && std::string(hash.data, hash.size) != out.probe.source_sha256 && !quiet)
        std::fprintf(stderr, "%s: made from another file than %s (its SHA-256 differs)\n", path.c_str(),
                     source.c_str());
    return out;
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
