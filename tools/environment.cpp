#include "environment.h"

#include "commands.h"

#include <cinttypes>
#include <cstdio>
#include <stdexcept>

namespace acdf::tools {
namespace {

using compress::Order;

std::string number(double value) {
    char text[32];
    std::snprintf(text, sizeof text, "%.9g", value);
    return text;
}

/// The options that shaped the file, in the words of the command line.
std::string option_text(const compress::FitOptions& fit, Order order) {
    std::string text = "--order " + std::string(to_string(order));
    if (fit.fit == ACDF_FIT_VARIANCE) return text + " --cells " + std::to_string(fit.cells);
    text += " --knots " + std::to_string(fit.column_segments) + "x" + std::to_string(fit.row_segments);
    if (fit.epsilon > 0.0) text += " --eps " + number(fit.epsilon);
    if (fit.gradient_knots > 0) text += " --gradient " + std::to_string(fit.gradient_knots);
    if (fit.conditional == compress::Conditional::mean) text += " --conditional mean";
    return text;
}

compress::Metadata metadata(const Source& source, const compress::FitOptions& fit, Order order,
                            const measure::Accuracy& accuracy) {
    return {{"tool", "acdf " ACDF_VERSION},
            {"fit.options", option_text(fit, order)},
            {"source.name", source.name},
            {"source.sha256", source.sha256},
            {"source.projection", source.projection},
            {"accuracy.relative_variance", number(accuracy.relative_variance)},
            {"accuracy.rms_pdf_error", number(accuracy.rms_pdf_error)},
            {"accuracy.kl_divergence", number(accuracy.kl_divergence)},
            {"accuracy.max_weight", number(accuracy.max_weight)}};
}

measure::Accuracy measure_bytes(const std::vector<std::uint8_t>& bytes, const compress::Target& target) {
    File file;
    if (const Status status = File::from_memory(bytes.data(), bytes.size(), file); !status.ok())
        throw std::logic_error(std::string("the file just made is not accepted: ") + status.message);
    return measure::measure_environment(file, target);
}

Environment build_in_order(const compress::Target& target, const Source& source, const EnvironmentOptions& options,
                           Order order, double total, const Progress& progress) {
    compress::FitOptions fit = options.fit;
    fit.order = order;
    fit.progress = [&](double share) {
        if (progress) progress(0.9 * share, "fitting");
    };
    const compress::EncodedTree tree = compress::encode_tree(compress::fit(target, fit));

    compress::Description description = compress::environment_description(target.columns, target.rows);
    description.fit = fit.fit;
    description.total = total;
    Environment out;
    out.order = order;
    out.accuracy = measure_bytes(compress::store(tree, description), target);
    description.metadata = metadata(source, fit, order, out.accuracy);
    out.bytes = compress::store(tree, description, options.codec);
    if (progress) progress(1.0, "measuring");
    return out;
}

} // namespace

const char* to_string(Order order) { return order == Order::phi ? "phi" : "z"; }

Environment build_environment(const compress::Target& target, const Source& source,
                              const EnvironmentOptions& options, const Progress& progress) {
    const double total = compress::integral(target);
    if (!(total > 0.0)) throw std::invalid_argument("a target without energy");
    if (options.order) return build_in_order(target, source, options, *options.order, total, progress);
    const auto part = [&](double begin) {
        return [&progress, begin](double share, const char* what) {
            if (progress) progress(begin + 0.5 * share, what);
        };
    };
    Environment z = build_in_order(target, source, options, Order::z, total, part(0.0));
    Environment phi = build_in_order(target, source, options, Order::phi, total, part(0.5));
    return phi.accuracy.relative_variance < z.accuracy.relative_variance ? phi : z;
}

compress::Target luminance_target(const std::string& path, const input::Probe& probe) {
    compress::Target target =
        compress::environment_target(probe.rgb.data(), static_cast<std::uint32_t>(probe.width),
                                     static_cast<std::uint32_t>(probe.height), compress::ChannelWeights{});
    if (!(compress::integral(target) > 0.0))
        throw Failure(path + ": the probe is black, so there is nothing to sample; is it the right file or layer?");
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

} // namespace acdf::tools
