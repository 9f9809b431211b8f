#include "environment.h"

#include "commands.h"
#include "option_text.h"

#include <algorithm>
#include <cstdio>
#include <stdexcept>

namespace acdf::tools {
namespace {

using compress::Order;

std::string knots_text(const compress::FitOptions& fit) {
    std::string text = "--knots " + std::to_string(fit.column_segments) + "x" + std::to_string(fit.row_segments);
    if (fit.epsilon > 0.0) text += " --eps " + option_number(fit.epsilon);
    if (fit.gradient_knots > 0) text += " --gradient " + std::to_string(fit.gradient_knots);
    if (fit.conditional == compress::Conditional::mean) text += " --conditional mean";
    return text;
}

compress::Metadata metadata(const Source& source, const EnvironmentOptions& options, std::optional<Order> tried,
                            const measure::Accuracy& accuracy) {
    compress::Metadata out{{"tool", "acdf " ACDF_VERSION},
                           {"fit.options", option_text(source.reading, options)},
                           {"source.name", source.name},
                           {"source.sha256", source.sha256},
                           {"source.projection", source.projection},
                           {"accuracy.relative_variance", accuracy_text(accuracy.relative_variance)},
                           {"accuracy.rms_pdf_error", accuracy_text(accuracy.rms_pdf_error)},
                           {"accuracy.kl_divergence", accuracy_text(accuracy.kl_divergence)},
                           {"accuracy.max_weight", accuracy_text(accuracy.max_weight)}};
    if (tried) out.push_back({"fit.order", to_string(*tried)});
    return out;
}

measure::Accuracy measure_bytes(const std::vector<std::uint8_t>& bytes, const compress::Target& target) {
    File file;
    if (const Status status = File::from_memory(bytes.data(), bytes.size(), file); !status.ok())
        throw std::logic_error(std::string("the file just made is not accepted: ") + status.message);
    return measure::measure_environment(file, target);
}

/// Splits in the order `tried`, if it is one, in place of that of the options.
Environment build_once(const compress::Target& target, const Source& source, const EnvironmentOptions& options,
                       std::optional<Order> tried, const Progress& progress) {
    compress::Description description = compress::environment_description(target.columns, target.rows);
    description.fit = options.fit.fit;
    description.total = target.total;
    description.filter = options.target.filter;
    description.channels = options.target.channels;
    const compress::ChannelWeights& weights = options.target.weights;
    const double stored_weights[3] = {weights.r, weights.g, weights.b};
    std::copy(std::begin(stored_weights), std::end(stored_weights), description.channel_weights);
    description.metadata = metadata(source, options, tried, {});

    compress::FitOptions fit = options.fit;
    if (tried) fit.order = tried;
    fit.file_size = [&](const compress::EncodedTree& tree) {
        return std::uint64_t{compress::store(tree, description, options.codec).size()};
    };
    fit.size_by_length = options.codec == ACDF_CODEC_NONE;
    fit.progress = [&](double share) {
        if (progress) progress(0.9 * share, "fitting");
    };
    const compress::EncodedTree tree = compress::fit(target, fit).tree;
    Environment out;
    out.order = fit.order;
    out.accuracy = measure_bytes(compress::store(tree, description), target);
    description.metadata = metadata(source, options, tried, out.accuracy);
    out.bytes = compress::store(tree, description, options.codec);
    if (progress) progress(1.0, "measuring");
    return out;
}

/// Both orders; `progress` covers them in turn.
Environment build_better(const compress::Target& target, const Source& source, const EnvironmentOptions& options,
                         const Progress& progress) {
    const auto build = [&](Order order, double begin) {
        return build_once(target, source, options, order, [&progress, begin](double share, const char* what) {
            if (progress) progress(begin + 0.5 * share, what);
        });
    };
    Environment z = build(Order::z, 0.0), phi = build(Order::phi, 0.5);
    return phi.accuracy.relative_variance < z.accuracy.relative_variance ? phi : z;
}

} // namespace

const char* to_string(Order order) { return order == Order::phi ? "phi" : "z"; }

Source source_of(const input::Probe& probe, const input::ProbeOptions& options) {
    return {probe.source_name, probe.source_sha256, input::to_string(probe.projection), reading_text(options)};
}

std::string reading_text(const input::ProbeOptions& options) {
    std::string text;
    if (options.projection != input::Projection::automatic)
        text += std::string("--projection ") + input::to_string(options.projection) + " ";
    if (options.bad_pixels == input::BadPixels::clamp) text += "--bad-pixels clamp ";
    return options.uniform_if_black ? text + "--on-black uniform " : text;
}

std::string option_text(const std::string& reading, const EnvironmentOptions& options) {
    const compress::FitOptions& fit = options.fit;
    std::string text = reading + target_text(options.target) + codec_text(options.codec) + fit_text(fit.fit);
    if (fit.order) text += "--order " + std::string(to_string(*fit.order)) + " ";
    if (fit.fit != ACDF_FIT_VARIANCE) return text + knots_text(fit);
    if (fit.shape == compress::Shape::cascade) text += "--shape cascade ";
    if (fit.max_weight > 0.0) text += "--max-weight " + option_number(fit.max_weight) + " ";
    return text + goal_text(fit.goal);
}

Environment build_environment(const compress::Target& target, const Source& source,
                              const EnvironmentOptions& options, const Progress& progress) {
    if (!(compress::integral(target) > 0.0)) throw std::invalid_argument("a target without energy");
    const bool tree = options.fit.fit == ACDF_FIT_VARIANCE && options.fit.shape == compress::Shape::tree;
    return tree || options.fit.order ? build_once(target, source, options, {}, progress)
                                     : build_better(target, source, options, progress);
}

namespace {

/// Rows of a probe on their way into a target.
class TargetRows : public input::ProbeRows {
public:
    explicit TargetRows(const compress::TargetOptions& options) : options_(options) {}
    void begin(int width, int height) override {
        target_.emplace(static_cast<std::uint32_t>(width), static_cast<std::uint32_t>(height), options_);
    }
    void take(int first, int count, const float* rgb) override {
        target_->take(static_cast<std::uint32_t>(first), static_cast<std::uint32_t>(count), rgb);
    }
    compress::Target finish() { return target_->finish(); }

private:
    compress::TargetOptions options_;
    std::optional<compress::EnvironmentTarget> target_;
};

compress::Target lit(const std::string& path, compress::Target target) {
    if (!(compress::integral(target) > 0.0))
        throw Failure(path +
                      ": the probe is black in the channels asked for, so there is nothing to sample; is it the "
                      "right file or layer? (what is black in all channels is accepted with --on-black uniform)");
    return target;
}

void tell(const input::Probe& probe, const input::ProbeOptions& options, const Note& note) {
    const auto size = [](int width, int height) { return std::to_string(width) + "x" + std::to_string(height); };
    const bool resampled = probe.projection != input::Projection::latlong;
    if (resampled || options.projection == input::Projection::automatic)
        note(std::string(input::to_string(probe.projection)) + " (" + probe.projection_reason + "), " +
             size(probe.source_width, probe.source_height) +
             (resampled ? ", resampled to a " + size(probe.width, probe.height) + " lat-long map" : ""));
    const input::BadTexels& bad = probe.bad;
    if (bad.count() > 0)
        note(std::to_string(bad.nan) + " NaN, " + std::to_string(bad.infinite) + " infinite and " +
             std::to_string(bad.negative) + " negative texels " +
             (options.bad_pixels == input::BadPixels::clamp ? "clamped" : "set to 0") + ", the first at " +
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
    tell(probe, options, notes_of(path, quiet));
    return probe;
}

ProbeTarget load_target(const std::string& path, const input::ProbeOptions& options,
                        const compress::TargetOptions& target_options, const Note& note) {
    TargetRows rows(target_options);
    input::Probe probe = input::read_probe(path, options, rows);
    tell(probe, options, note);
    return {std::move(probe), lit(path, rows.finish())};
}

compress::Target source_target(const std::string& path, const File& file, const std::string& source,
                               const input::ProbeOptions& options, bool quiet) {
    const AcdfDescription& d = file.description();
    auto [probe, target] = load_target(source, options,
                                       {{d.channel_weights[0], d.channel_weights[1], d.channel_weights[2]},
                                        static_cast<AcdfChannels>(d.channels),
                                        static_cast<AcdfFilter>(d.filter)},
                                       notes_of(source, quiet));
    const Text hash = file.metadata("source.sha256");
    if (hash.size > 0 && std::string(hash.data, hash.size) != probe.source_sha256 && !quiet)
        std::fprintf(stderr, "%s: made from another file than %s (its SHA-256 differs)\n", path.c_str(),
                     source.c_str());
    const AcdfAxis &phi = file.axis(ACDF_AXIS_PHI), &theta = file.axis(ACDF_AXIS_THETA);
    if (phi.resolution != target.columns || theta.resolution != target.rows)
        throw Failure(source + ": is " + std::to_string(target.columns) + "x" + std::to_string(target.rows) +
                      " as a lat-long map, but " + path + " was made from " + std::to_string(phi.resolution) + "x" +
                      std::to_string(theta.resolution) + "; measure against the source it was made from");
    return target;
}

} // namespace acdf::tools
