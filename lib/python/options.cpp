#include "python/options.h"

#include "build/text/options.h"

#include <pybind11/stl.h>

#include <cstring>

namespace acdf::python {
namespace {

using namespace acdf::builder;

builder::Source source_of(const Options& options) {
    builder::Source source;
    options.take("source_name", source.name);
    return source;
}

/// The one that is named; null where none is.
const Renderer* renderer_of(const Options& options) {
    if (!options.has("for_renderer")) return nullptr;
    const std::string name = py::str(options.get("for_renderer"));
    if (const Renderer* renderer = find_renderer(name.c_str())) return renderer;
    std::string names;
    for (const Renderer& renderer : renderers()) names += (names.empty() ? "" : ", ") + std::string(renderer.name);
    throw py::value_error("for_renderer: '" + name + "' is none of " + names);
}

TargetOptions target_options(const Options& options) {
    const Renderer* renderer = renderer_of(options);
    TargetOptions target = renderer ? renderer->target : TargetOptions{};
    target.channels = channels_of(options, target.channels);
    options.choose<Domain>(
        "domain", {{"source", Domain::source}, {"latlong", Domain::latlong}, {"octahedral", Domain::octahedral}},
        target.domain);
    options.choose<AcdfFilter>("filter", {{"nearest", ACDF_FILTER_NEAREST}, {"bilinear", ACDF_FILTER_BILINEAR}},
                               target.filter);
    options.choose<Wrap>("wrap", {{"clamp", Wrap::clamp}, {"repeat", Wrap::repeat}}, target.wrap);
    options.choose<BadTexelPolicy>(
        "bad_texels",
        {{"zero", BadTexelPolicy::zero}, {"clamp", BadTexelPolicy::clamp}, {"error", BadTexelPolicy::error}},
        target.bad_texels);
    options.take("uniform_if_black", target.uniform_if_black);
    return target;
}

FitOptions fit_options(const Options& options) {
    FitOptions fit;
    options.choose<AcdfFit>("fit",
                            {{"variance", ACDF_FIT_VARIANCE},
                             {"cdf", ACDF_FIT_CDF},
                             {"pdf", ACDF_FIT_PDF},
                             {"uniform", ACDF_FIT_UNIFORM}},
                            fit.fit);
    options.take("max_weight", fit.max_weight);
    return fit;
}

Partner partner_of(const Options& options, Partner partner = {}) {
    options.choose<AcdfPartnerKind>("mis",
                                    {{"none", ACDF_PARTNER_NONE},
                                     {"cosine", ACDF_PARTNER_COSINE},
                                     {"brdf", ACDF_PARTNER_BRDF},
                                     {"mean", ACDF_PARTNER_MEAN}},
                                    partner.kind);
    options.choose<AcdfHeuristic>(
        "heuristic", {{"balance", ACDF_HEURISTIC_BALANCE}, {"power", ACDF_HEURISTIC_POWER}}, partner.heuristic);
    std::pair<double, double> shares{partner.light, partner.other};
    options.take("shares", shares);
    partner.light = shares.first, partner.other = shares.second;
    return partner;
}

std::vector<SceneNormal> normals_of(const Options& options) {
    std::vector<SceneNormal> out;
    if (!options.has("normals")) return out;
    const Rows<float> normals = rows<float>(options.get("normals"), 3, "normals");
    out.resize(normals.count);
    for (std::size_t i = 0; i < normals.count; ++i)
        std::memcpy(out[i].normal, normals.data() + 3 * i, sizeof out[i].normal);
    if (!options.has("normal_weights")) return out;
    const py::array given = numbers(options.get("normal_weights"), "normal_weights", "fiu");
    const auto weights = py::array_t<double, py::array::c_style | py::array::forcecast>::ensure(given);
    if (!weights) no_memory("normal_weights");
    if (static_cast<std::size_t>(weights.size()) != out.size())
        throw py::value_error("normal_weights: " + std::to_string(weights.size()) + " of them for " +
                              std::to_string(out.size()) + " normals");
    for (std::size_t i = 0; i < out.size(); ++i) out[i].weight = weights.data()[i];
    return out;
}

} // namespace

Numbers number_array(const py::object& given, const char* name) {
    Numbers out = {numbers(given, name, "fiu"), Number::float64};
    const py::dtype dtype = out.array.dtype();
    const auto is = [&](const char* type) { return dtype.is(py::dtype(type)) || dtype.equal(py::dtype(type)); };
    if (is("float16")) out.number = Number::float16;
    else if (is("float32")) out.number = Number::float32;
    else if (!is("float64")) out.array = py::array_t<double, py::array::forcecast>::ensure(out.array);
    if (!out.array) no_memory(name);
    for (py::ssize_t i = 0; i < out.array.ndim(); ++i) // what is broadcast overlaps, which the builder refuses
        if (out.array.strides(i) == 0 && out.array.shape(i) > 1) {
            out.array = py::array(py::module_::import("numpy").attr("ascontiguousarray")(out.array));
            break;
        }
    return out;
}

Goal goal_of(const Options& options, const Goal& otherwise) {
    const int given = options.has("cells") + options.has("budget") + options.has("variance");
    if (given > 1) throw py::value_error("cells, budget and variance are three goals; give one");
    Goal goal = otherwise;
    if (options.has("cells")) options.take("cells", (goal = Goal::of_cells(0)).cells);
    if (options.has("budget")) options.take("budget", (goal = Goal::of_budget(0)).budget);
    if (options.has("variance")) options.take("variance", (goal = Goal::of_variance(0.0)).variance);
    return goal;
}

AcdfCodec codec_of(const Options& options) {
    AcdfCodec codec = ACDF_CODEC_NONE;
    options.choose<AcdfCodec>(
        "compress", {{"none", ACDF_CODEC_NONE}, {"zlib", ACDF_CODEC_ZLIB}, {"planes", ACDF_CODEC_PLANES}}, codec);
    return codec;
}

Channels channels_of(const Options& options, const Channels& otherwise) {
    if (!options.has("channel")) return otherwise;
    const std::string wanted = py::str(options.get("channel"));
    std::string names;
    for (const build::ChannelName& name : build::channel_names) {
        if (wanted == name.name) return {name.channels, {name.weights.r, name.weights.g, name.weights.b}};
        names += (names.empty() ? "" : ", ") + std::string(name.name);
    }
    throw py::value_error("channel: '" + wanted + "' is none of " + names);
}

EnvironmentOptions environment_options(const Options& options) {
    EnvironmentOptions out;
    out.target = target_options(options);
    out.goal = goal_of(options, out.goal);
    out.fit = fit_options(options);
    out.normals = normals_of(options);
    const Renderer* renderer = renderer_of(options);
    out.mis = partner_of(options, renderer ? renderer->partner(out) : Partner{});
    out.codec = codec_of(options);
    out.source = source_of(options);
    return out;
}

LocalOptions local_options(const Options& options) {
    LocalOptions out;
    out.target = target_options(options);
    out.goal = goal_of(options, out.goal);
    options.take("subdivisions", out.subdivisions);
    options.take("tiles", out.tiles);
    out.normals = normals_of(options);
    options.take("max_weight", out.max_weight);
    options.take("cosine_share", out.cosine_share);
    options.take("sharing", out.sharing);
    const Renderer* renderer = renderer_of(options);
    out.mis = partner_of(options, renderer ? renderer->partner(out) : Partner{});
    out.codec = codec_of(options);
    out.source = source_of(options);
    return out;
}

BrdfOptions brdf_options(const Options& options) {
    BrdfOptions out;
    out.channels = channels_of(options);
    out.goal = goal_of(options, out.goal);
    options.take("theta_views", out.theta_views);
    options.take("phi_views", out.phi_views);
    options.take("max_weight", out.max_weight);
    options.take("diffuse_share", out.diffuse_share);
    out.codec = codec_of(options);
    out.source = source_of(options);
    return out;
}

IndexedOptions indexed_options(const Options& options) {
    IndexedOptions out;
    out.target = target_options(options);
    out.goal = goal_of(options, out.goal);
    std::vector<std::pair<std::string, std::vector<double>>> axes;
    options.take("axes", axes);
    for (auto& [name, coordinates] : axes) out.axes.push_back({std::move(name), std::move(coordinates)});
    options.take("sun", out.sun);
    options.take("suns", out.suns);
    out.codec = codec_of(options);
    out.source = source_of(options);
    return out;
}

TableOptions table_options(const Options& options) {
    TableOptions out;
    options.take("indexed", out.indexed);
    options.take("names", out.names);
    options.take("ranges", out.ranges);
    out.goal = goal_of(options, out.goal);
    options.take("max_weight", out.max_weight);
    options.take("bad_as_zero", out.bad_as_zero);
    out.codec = codec_of(options);
    out.source = source_of(options);
    return out;
}

} // namespace acdf::python
