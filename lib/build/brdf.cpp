#include "build/brdf.h"

#include "build/compressed_budget.h"
#include "build/text/options.h"
#include "build/weight_bound.h"

#include <acdf/curves/curves.h>
#include <acdf/reader.h>
#include <acdf/views.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <numeric>
#include <stdexcept>

namespace acdf::build {
namespace {

compress::Metadata metadata(const Brdf& brdf, const BrdfFileOptions& options, const BrdfAccuracy& a) {
    compress::Metadata out{
        {"tool", "acdf " ACDF_VERSION}, {"fit.options", option_text(options)}, {"source.name", brdf.name}};
    if (!brdf.sha256.empty()) out.push_back({"source.sha256", brdf.sha256});
    out.push_back({"accuracy.relative_variance", accuracy_text(a.relative_variance)});
    out.push_back({"accuracy.relative_variance_median", accuracy_text(a.median)});
    out.push_back({"accuracy.relative_variance_worst", accuracy_text(a.worst)});
    out.push_back({"accuracy.rms_pdf_error", accuracy_text(a.rms_pdf_error)});
    out.push_back({"accuracy.kl_divergence", accuracy_text(a.kl_divergence)});
    out.push_back({"accuracy.max_weight", accuracy_text(a.max_weight)});
    out.push_back({"accuracy.share_above_horizon", accuracy_text(a.share_above_horizon)});
    return out;
}

compress::Chunk views_chunk(const compress::BrdfFit& fit, float diffuse_share) {
    const AcdfViews header = {static_cast<std::uint32_t>(fit.nodes.size()), fit.phi_views,
                              fit.mirrored ? ACDF_VIEWS_MIRRORED : 0u, diffuse_share};
    compress::Chunk chunk{ACDF_CHUNK_VIEWS, {}};
    const std::size_t bytes = fit.nodes.size() * sizeof(float);
    chunk.bytes.resize(sizeof header + bytes);
    std::memcpy(chunk.bytes.data(), &header, sizeof header);
    std::memcpy(chunk.bytes.data() + sizeof header, fit.nodes.data(), bytes);
    return chunk;
}

BrdfAccuracy measure_bytes(const std::vector<std::uint8_t>& bytes, const compress::Reflected& reflected,
                           const std::vector<compress::View>& views, Sides sides) {
    File file;
    if (const Status status = File::from_memory(bytes.data(), bytes.size(), file, with_curves()); !status.ok())
        throw std::logic_error(std::string("the reader refuses the file just made: ") + status.message);
    BrdfAccuracy out = summary(measure_views(file, reflected, views, sides));
    out.cells = brdf_cells(file);
    return out;
}

} // namespace

std::string option_text(const BrdfFileOptions& options) {
    const compress::BrdfOptions& fit = options.fit;
    std::string text = target_text({options.weights, options.channels, ACDF_FILTER_BILINEAR}) +
                       codec_text(options.codec) + fit_text(fit.fit);
    if (fit.theta_views) {
        text += "--views " + std::to_string(fit.theta_views);
        text += (fit.phi_views > 1 ? "x" + std::to_string(fit.phi_views) : "") + " ";
    }
    if (options.diffuse_share > 0.0f) text += "--diffuse-floor " + option_number(options.diffuse_share) + " ";
    if (options.max_weight > 0.0) text += "--max-weight " + option_number(options.max_weight) + " ";
    if (fit.fit == ACDF_FIT_VARIANCE) return text + goal_text(fit.goal);
    text += "--knots " + std::to_string(fit.phi_segments) + "x" + std::to_string(fit.theta_segments);
    return fit.epsilon > 0.0 ? text + " --eps " + option_number(fit.epsilon) : text;
}

namespace {

/// Darker values are taken as black, in sr^-1: fits and sums divide by the light of a view, and square it.
constexpr double kLeastReflected = 1e-100;

/// The brightness over all channels, by a file's weights.
double brightness(const double rgb[3], AcdfChannels channels, const compress::ChannelWeights& weights) {
    if (channels == ACDF_CHANNELS_SEPARATE) return std::sqrt(rgb[0] * rgb[0] + rgb[1] * rgb[1] + rgb[2] * rgb[2]);
    if (channels == ACDF_CHANNELS_LARGEST) return std::max({rgb[0], rgb[1], rgb[2]});
    return weights.r * rgb[0] + weights.g * rgb[1] + weights.b * rgb[2];
}

} // namespace

compress::Reflected reflected_light(const Brdf& brdf, AcdfChannels channels,
                                    const compress::ChannelWeights& weights) {
    return [&brdf, channels, weights](const double wo[3], const double wi[3]) {
        double rgb[3];
        brdf.evaluate(wo, wi, rgb);
        const double light = brightness(rgb, channels, weights);
        return light < kLeastReflected ? 0.0 : std::max(0.0, wi[2]) * light;
    };
}

Sides sides(const Brdf& brdf) {
    return brdf.isotropic && brdf.mirror && brdf.asymmetry == 0.0 ? Sides::alike : Sides::any;
}

std::vector<std::uint8_t> brdf_bytes(const compress::BrdfFit& fit, const BrdfFileOptions& options,
                                     const compress::Metadata& metadata) {
    constexpr double pi = ACDF_PI;
    compress::Description d;
    d.kind = ACDF_KIND_BRDF;
    d.parameterization = ACDF_PARAM_HALF_ANGLE;
    d.fit = options.fit.fit;
    d.channels = options.channels;
    d.channel_weights[0] = options.weights.r;
    d.channel_weights[1] = options.weights.g;
    d.channel_weights[2] = options.weights.b;
    d.total = fit.total > 0.0 ? fit.total : 1.0;
    d.shares = fit.shares;
    d.axes = {{"phi_h", ACDF_AXIS_SAMPLED, ACDF_MEASURE_LINEAR, compress::HalfGrid::column_resolution,
               fit.mirrored ? 0.0 : -pi, pi},
              {"cos_theta_h", ACDF_AXIS_SAMPLED, fit.halved() ? ACDF_MEASURE_HALF : ACDF_MEASURE_LINEAR,
               fit.halved() ? std::uint32_t{ACDF_HALF_ROWS} : compress::HalfGrid::row_resolution, 1.0, 0.0},
              {"theta_o", ACDF_AXIS_INDEXED, ACDF_MEASURE_LINEAR, static_cast<std::uint32_t>(fit.nodes.size()), 0.0,
               0.5 * pi},
              {"phi_o", ACDF_AXIS_INDEXED, ACDF_MEASURE_LINEAR, fit.phi_views, -pi, pi}};
    d.chunks.push_back(views_chunk(fit, options.diffuse_share));
    d.metadata = metadata;
    if (!fit.halved()) return compress::store(fit.tree, d, options.codec);
    std::vector<std::uint32_t> roots(fit.bins()); // each bin its own row
    std::iota(roots.begin(), roots.end(), 0u);
    d.chunks.push_back(compress::rows_chunk(fit.rows));
    return compress::store(fit.rows.halvings, roots, d, options.codec);
}

namespace {

/// What of a BRDF and its options every attempt at a file has in common.
struct Task {
    Task(const Brdf& b, const BrdfFileOptions& given)
        : brdf(b), options(given), reflected(reflected_light(b, given.channels, given.weights)) {
        const bool isotropic = b.isotropic && given.fit.phi_views <= 1;
        options.fit.symmetry = {isotropic, isotropic && b.mirror};
        unknown = metadata(b, options, {});
    }

    const Brdf& brdf;
    BrdfFileOptions options;
    compress::Reflected reflected;
    compress::Metadata unknown; ///< with zeros for the accuracy: of the same size
};

/// A file whose accuracy is not measured yet, which changes none of its size.
struct BrdfDraft {
    compress::BrdfFit fit;
    std::vector<std::uint8_t> bytes;
};

/// `goal`: before compression; what the file says of its options keeps that of the task. `max_weight`: 0 for that
/// of the task.
BrdfDraft draft(const Task& task, const compress::Goal& goal, double max_weight, const Progress& progress) {
    BrdfFileOptions plain = task.options; // how well rows compress is unknown before they are made
    plain.codec = ACDF_CODEC_NONE;
    compress::BrdfOptions fit_options = task.options.fit;
    fit_options.goal = goal;
    if (max_weight > 0.0) fit_options.max_weight = max_weight;
    fit_options.file_size = [&](const compress::BrdfFit& fit) {
        return std::uint64_t{brdf_bytes(fit, plain, task.unknown).size()};
    };
    fit_options.progress = [&](double share) {
        if (progress) progress(0.8 * share, "fitting");
    };
    BrdfDraft out{compress::fit_brdf(task.reflected, fit_options), {}};
    out.bytes = brdf_bytes(out.fit, task.options, task.unknown);
    return out;
}

BrdfFile finish(const Task& task, const BrdfDraft& draft, const Progress& progress) {
    if (progress) progress(0.8, "measuring");
    BrdfFile out;
    out.accuracy = measure_bytes(draft.bytes, task.reflected,
                                 random_views(task.options.measured_views, task.brdf.isotropic), sides(task.brdf));
    out.bytes = brdf_bytes(draft.fit, task.options, metadata(task.brdf, task.options, out.accuracy));
    out.theta_views = static_cast<std::uint32_t>(draft.fit.nodes.size());
    out.phi_views = draft.fit.phi_views;
    return out;
}

} // namespace

BrdfFile build_brdf(const Brdf& brdf, const BrdfFileOptions& options, const Progress& progress) {
    const Task task(brdf, options);
    const compress::Goal& goal = options.fit.goal;
    return within_weight(options.max_weight, [&](double max_weight) {
        if (options.codec == ACDF_CODEC_NONE || goal.kind != compress::Goal::Kind::budget)
            return finish(task, draft(task, goal, max_weight, progress), progress);
        const BrdfDraft best = fill_compressed(goal.budget, [&](std::uint64_t bytes) {
            compress::Goal plain = goal;
            plain.budget = bytes;
            return draft(task, plain, max_weight, progress);
        });
        return finish(task, best, progress);
    });
}

} // namespace acdf::build
