#include "build/environment.h"

#include "build/accuracy/partner.h"
#include "build/errors.h"
#include "build/local.h"
#include "build/text/options.h"
#include "build/text/partner.h"
#include "compress/halvings/fit.h"
#include "compress/partner/target.h"

#include <acdf/curves/curves.h>

#include <algorithm>
#include <cstdio>
#include <stdexcept>
#include <variant>

namespace acdf::build {
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
                            const Accuracy& accuracy) {
    compress::Metadata out{{"tool", "acdf " ACDF_VERSION},
                           {"fit.options", option_text(source.reading, options)},
                           {"source.name", source.name},
                           {"source.sha256", source.sha256},
                           {"source.projection", source.projection},
                           {"accuracy.relative_variance", accuracy_text(accuracy.relative_variance)}};
    if (!options.mis) { // the pdf of a file for an MIS partner is not to be near the light's
        out.push_back({"accuracy.rms_pdf_error", accuracy_text(accuracy.rms_pdf_error)});
        out.push_back({"accuracy.kl_divergence", accuracy_text(accuracy.kl_divergence)});
    }
    out.push_back({"accuracy.max_weight", accuracy_text(accuracy.max_weight)});
    if (tried) out.push_back({"fit.order", to_string(*tried)});
    return out;
}

constexpr std::uint32_t kNormalsPerEdge = 8; // of an octahedron: the normals that an MIS partner lights

/// What is fitted.
compress::Target fitted_target(const compress::Target& target, const EnvironmentOptions& options) {
    compress::NormalBins normals = compress::octahedral_bins(kNormalsPerEdge);
    if (!options.scene.empty()) compress::weigh(normals, options.scene);
    return compress::partner_target(target, normals, options.mis);
}

/// Writes into the file what the partner was found to leave to it.
void recommend(const std::vector<std::uint8_t>& bytes, const compress::Target& target,
               const EnvironmentOptions& options, compress::Description& description) {
    File file;
    if (!File::from_memory(bytes.data(), bytes.size(), file, with_curves()).ok())
        return; // measure_bytes reports it
    const double share = recommended_light_share(file, target, test_normals(options.scene, 64));
    description.chunks = {compress::partner_chunk(options.mis, static_cast<float>(share), {})};
}

std::string out_of_budget(std::uint64_t budget, const compress::Description& description) {
    compress::Halvings leaf;
    leaf.axes = {-1};
    return "a size of " + std::to_string(budget) + " bytes is out of reach; the smallest possible is " +
           std::to_string(compress::store(leaf, description).size());
}

Accuracy measure_bytes(const std::vector<std::uint8_t>& bytes, const compress::Target& target) {
    File file;
    if (const Status status = File::from_memory(bytes.data(), bytes.size(), file, with_curves()); !status.ok())
        throw std::logic_error(std::string("the reader refuses the file just made: ") + status.message);
    return measure_environment(file, target);
}

/// Halvings of the variance fit, curves of the others.
struct FittedTree {
    std::variant<compress::Halvings, compress::EncodedTree> of;

    std::vector<std::uint8_t> stored(const compress::Description& description,
                                     AcdfCodec codec = ACDF_CODEC_NONE) const {
        return std::visit([&](const auto& tree) { return compress::store(tree, description, codec); }, of);
    }
};

compress::Halvings fit_halvings(const compress::Target& target, const EnvironmentOptions& options,
                                const compress::Description& description, const compress::Progress& progress) {
    compress::HalvingsOptions fit;
    fit.goal = options.fit.goal;
    fit.max_weight = options.fit.max_weight;
    fit.most_bytes = kMostBytesForVariance;
    fit.progress = progress;
    if (fit.goal.kind == compress::Goal::Kind::budget) {
        fit.chunk_bytes = compress::halvings_room(description, fit.goal.budget);
        if (fit.chunk_bytes == 0) throw std::runtime_error(out_of_budget(fit.goal.budget, description));
    }
    return options.mis ? compress::fit_halvings(fitted_target(target, options), fit)
                       : compress::fit_halvings(target, fit);
}

FittedTree fit_tree(const compress::Target& target, const EnvironmentOptions& options, std::optional<Order> tried,
                    const compress::Description& description, const compress::Progress& progress) {
    if (options.fit.fit == ACDF_FIT_VARIANCE) return {fit_halvings(target, options, description, progress)};
    compress::FitOptions fit = options.fit;
    if (tried) fit.order = tried;
    fit.progress = progress;
    return {compress::fit(target, fit).tree};
}

/// Splits in the order `tried`, if it is one, in place of that of the options.
Environment build_once(const compress::Target& target, const Source& source, const EnvironmentOptions& options,
                       std::optional<Order> tried, const Progress& progress) {
    compress::Description description =
        compress::environment_description(target.columns, target.rows, target.parameterization);
    description.fit = options.fit.fit;
    description.total = target.total;
    description.filter = options.target.filter;
    description.channels = options.target.channels;
    const compress::ChannelWeights& weights = options.target.weights;
    const double stored_weights[3] = {weights.r, weights.g, weights.b};
    std::copy(std::begin(stored_weights), std::end(stored_weights), description.channel_weights);
    description.metadata = metadata(source, options, tried, {});
    if (options.mis) description.chunks = {compress::partner_chunk(options.mis, 0.5f, {})};

    const FittedTree tree = fit_tree(target, options, tried, description, [&](double share) {
        if (progress) progress(0.9 * share, "fitting");
    });
    Environment out;
    out.order = tried ? tried : options.fit.order;
    if (options.mis) recommend(tree.stored(description), target, options, description);
    out.accuracy = measure_bytes(tree.stored(description), target);
    description.metadata = metadata(source, options, tried, out.accuracy);
    out.bytes = tree.stored(description, options.codec);
    if (progress) progress(1.0, "measuring");
    return out;
}

/// Builds with both orders of axes, and keeps the better; `progress` covers them in turn.
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

std::string option_text(const std::string& reading, const EnvironmentOptions& options) {
    const compress::FitOptions& fit = options.fit;
    std::string text = reading + target_text(options.target) + codec_text(options.codec) + fit_text(fit.fit);
    if (fit.order) text += "--order " + std::string(to_string(*fit.order)) + " ";
    if (fit.fit != ACDF_FIT_VARIANCE) return text + knots_text(fit);
    text += partner_text(options.mis);
    if (options.mis && !options.scene.empty())
        text += options.scene_text.empty() ? "--scene " : options.scene_text + " ";
    if (fit.max_weight > 0.0) text += "--max-weight " + option_number(fit.max_weight) + " ";
    return text + goal_text(fit.goal);
}

Environment build_environment(const compress::Target& target, const Source& source,
                              const EnvironmentOptions& options, const Progress& progress) {
    if (!compress::has_energy(target)) throw NoEnergy("a target without energy");
    return options.fit.fit == ACDF_FIT_VARIANCE || options.fit.order
               ? build_once(target, source, options, {}, progress)
               : build_better(target, source, options, progress);
}

} // namespace acdf::build
