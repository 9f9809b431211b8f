#include "environment.h"

#include "commands.h"

#include <algorithm>
#include <cinttypes>
#include <cstdio>
#include <stdexcept>

namespace acdf::tools {
namespace {

using compress::Order;

std::string number(double value, const char* format = "%.9g") {
    char text[32];
    std::snprintf(text, sizeof text, format, value);
    return text;
}

std::string goal_text(const compress::Goal& goal) {
    switch (goal.kind) {
    case compress::Goal::Kind::budget:
        return "--budget " + std::to_string(goal.budget);
    case compress::Goal::Kind::variance:
        return "--target-variance " + number(goal.variance);
    default:
        return "--cells " + std::to_string(goal.cells);
    }
}

/// The options that shaped the file, in the words of the command line.
std::string option_text(const compress::FitOptions& fit) {
    std::string text = fit.order ? "--order " + std::string(to_string(*fit.order)) + " " : "";
    if (fit.fit == ACDF_FIT_VARIANCE) {
        if (fit.shape == compress::Shape::cascade) text += "--shape cascade ";
        if (fit.max_weight > 0.0) text += "--max-weight " + number(fit.max_weight) + " ";
        return text + goal_text(fit.goal);
    }
    text += "--knots " + std::to_string(fit.column_segments) + "x" + std::to_string(fit.row_segments);
    if (fit.epsilon > 0.0) text += " --eps " + number(fit.epsilon);
    if (fit.gradient_knots > 0) text += " --gradient " + std::to_string(fit.gradient_knots);
    if (fit.conditional == compress::Conditional::mean) text += " --conditional mean";
    return text;
}

compress::Metadata metadata(const Source& source, const compress::FitOptions& fit,
                            const measure::Accuracy& accuracy) {
    // A fixed width: what accuracy is reached must not change the size that a budget is compared with.
    const auto fixed = [](double value) { return number(std::clamp(value, 0.0, 9.99e99), "%.8e"); };
    return {{"tool", "acdf " ACDF_VERSION},
            {"fit.options", option_text(fit)},
            {"source.name", source.name},
            {"source.sha256", source.sha256},
            {"source.projection", source.projection},
            {"accuracy.relative_variance", fixed(accuracy.relative_variance)},
            {"accuracy.rms_pdf_error", fixed(accuracy.rms_pdf_error)},
            {"accuracy.kl_divergence", fixed(accuracy.kl_divergence)},
            {"accuracy.max_weight", fixed(accuracy.max_weight)}};
}

measure::Accuracy measure_bytes(const std::vector<std::uint8_t>& bytes, const compress::Target& target) {
    File file;
    if (const Status status = File::from_memory(bytes.data(), bytes.size(), file); !status.ok())
        throw std::logic_error(std::string("the file just made is not accepted: ") + status.message);
    return measure::measure_environment(file, target);
}

Environment build_once(const compress::Target& target, const Source& source, const EnvironmentOptions& options,
                       const Progress& progress) {
    compress::Description description = compress::environment_description(target.columns, target.rows);
    description.fit = options.fit.fit;
    description.total = target.total;
    description.filter = options.target.filter;
    description.channels = options.target.channels;
    const compress::ChannelWeights& weights = options.target.weights;
    const double stored_weights[3] = {weights.r, weights.g, weights.b};
    std::copy(std::begin(stored_weights), std::end(stored_weights), description.channel_weights);
    description.metadata = metadata(source, options.fit, {});

    compress::FitOptions fit = options.fit;
    fit.file_size = [&](const compress::EncodedTree& tree) {
        return std::uint64_t{compress::store(tree, description, options.codec).size()};
    };
    fit.progress = [&](double share) {
        if (progress) progress(0.9 * share, "fitting");
    };
    const compress::EncodedTree tree = compress::fit(target, fit).tree;
    Environment out;
    out.order = fit.order;
    out.accuracy = measure_bytes(compress::store(tree, description), target);
    description.metadata = metadata(source, options.fit, out.accuracy);
    out.bytes = compress::store(tree, description, options.codec);
    if (progress) progress(1.0, "measuring");
    return out;
}

/// Both orders; `progress` covers them in turn.
Environment build_better(const compress::Target& target, const Source& source, const EnvironmentOptions& options,
                         const Progress& progress) {
    const auto build = [&](Order order, double begin) {
        EnvironmentOptions one = options;
        one.fit.order = order;
        return build_once(target, source, one, [&progress, begin](double share, const char* what) {
            if (progress) progress(begin + 0.5 * share, what);
        });
    };
    Environment z = build(Order::z, 0.0), phi = build(Order::phi, 0.5);
    return phi.accuracy.relative_variance < z.accuracy.relative_variance ? phi : z;
}

} // namespace

const char* to_string(Order order) { return order == Order::phi ? "phi" : "z"; }

Environment build_environment(const compress::Target& target, const Source& source,
                              const EnvironmentOptions& options, const Progress& progress) {
    if (!(compress::integral(target) > 0.0)) throw std::invalid_argument("a target without energy");
    const bool tree = options.fit.fit == ACDF_FIT_VARIANCE && options.fit.shape == compress::Shape::tree;
    return tree || options.fit.order ? build_once(target, source, options, progress)
                                     : build_better(target, source, options, progress);
}

compress::Target probe_target(const std::string& path, const input::Probe& probe,
                              const compress::TargetOptions& options) {
    compress::Target target =
        compress::environment_target(probe.rgb.data(), static_cast<std::uint32_t>(probe.width),
                                     static_cast<std::uint32_t>(probe.height), options);
    if (!(compress::integral(target) > 0.0))
        throw Failure(path +
                      ": the probe is black in the channels asked for, so there is nothing to sample; is it the "
                      "right file or layer?");
    return target;
}

input::Probe load_probe(const std::string& path, const input::ProbeOptions& options, bool quiet) {
    input::Probe probe = input::read_probe(path, options);
    if (quiet) return probe;
    if (probe.projection != input::Projection::latlong || options.projection == input::Projection::automatic)
        std::fprintf(stderr, "%s: %s (%s), %dx%d", path.c_str(), input::to_string(probe.projection),
                     probe.projection_reason.c_str(), probe.source_width, probe.source_height);
    if (probe.projection != input::Projection::latlong)
        std::fprintf(stderr, ", resampled to a %dx%d lat-long map", probe.width, probe.height);
    if (probe.projection != input::Projection::latlong || options.projection == input::Projection::automatic)
        std::fputc('\n', stderr);
    const input::BadTexels& bad = probe.bad;
    if (bad.nan + bad.infinite + bad.negative > 0)
        std::fprintf(stderr,
                     "%s: %" PRIu64 " NaN, %" PRIu64 " infinite and %" PRIu64
                     " negative texels set to 0, the first at %d,%d\n",
                     path.c_str(), bad.nan, bad.infinite, bad.negative, bad.x, bad.y);
    return probe;
}

compress::Target source_target(const std::string& path, const File& file, const std::string& source,
                               const input::ProbeOptions& options, bool quiet) {
    const input::Probe probe = load_probe(source, options, quiet);
    const Text hash = file.metadata("source.sha256");
    if (hash.size > 0 && std::string(hash.data, hash.size) != probe.source_sha256 && !quiet)
        std::fprintf(stderr, "%s: made from another file than %s (its SHA-256 differs)\n", path.c_str(),
                     source.c_str());
    const AcdfDescription& d = file.description();
    compress::Target target = probe_target(source, probe,
                                           {{d.channel_weights[0], d.channel_weights[1], d.channel_weights[2]},
                                            static_cast<AcdfChannels>(d.channels),
                                            static_cast<AcdfFilter>(d.filter)});
    const AcdfAxis &phi = file.axis(ACDF_AXIS_PHI), &theta = file.axis(ACDF_AXIS_THETA);
    if (phi.resolution != target.columns || theta.resolution != target.rows)
        throw Failure(source + ": is " + std::to_string(target.columns) + "x" + std::to_string(target.rows) +
                      " as a lat-long map, but " + path + " was made from " + std::to_string(phi.resolution) + "x" +
                      std::to_string(theta.resolution) + "; measure against the source it was made from");
    return target;
}

} // namespace acdf::tools
