#include "tools/render/run.h"

#include "compress/sum.h"
#include "compress/target.h"
#include "input/probe/source.h"
#include "measure/scenes/reference.h"
#include "tools/demo/probes.h"
#include "tools/render/sampler_build.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>

namespace acdf::tools {
namespace {

input::Probe load_light(const SceneFile& file, const std::string& data) {
    if (!file.probe.empty()) {
        const std::string source = input::with_paths(
            file.probe, [&](const std::string& path) { return (std::filesystem::path(data) / path).string(); });
        return input::read_probe(source, file.reading);
    }
    std::string names;
    for (DemoProbe& demo : demo_probes()) {
        if (demo.name == file.built_in) {
            input::Probe probe;
            probe.width = demo.width;
            probe.height = demo.height;
            probe.rgb = std::move(demo.rgb);
            probe.source_name = demo.name;
            return probe;
        }
        names += (names.empty() ? "" : ", ") + demo.name;
    }
    throw SceneError("light.built_in: '" + file.built_in + "' is none of " + names);
}

std::string brdf_source(const std::string& brdf, const std::string& data) {
    const std::filesystem::path path = std::filesystem::path(data) / brdf;
    std::error_code ignored;
    return std::filesystem::exists(path, ignored) ? path.string()
                                                  : brdf; // else a model's text, or open_brdf complains
}

/// Of interpolated radiance, over each texel.
std::vector<float> texel_means(const measure::ProbeLight& light) {
    const compress::Target moments =
        compress::environment_target(light.rgb, light.columns, light.rows,
                                     {{1.0, 1.0, 1.0}, ACDF_CHANNELS_SEPARATE, light.filter, ACDF_PARAM_LATLONG});
    std::vector<float> out(3 * moments.values.size());
    for (std::size_t i = 0; i < moments.values.size(); ++i)
        for (std::size_t k = 0; k < 3; ++k) out[3 * i + k] = moments.means[k][i];
    return out;
}

double luminance_mean(const std::vector<measure::Rgb>& values) {
    compress::Sum sum;
    for (const measure::Rgb& value : values) sum.add(measure::luminance(value));
    return sum.value() / static_cast<double>(values.size());
}

double median_of(std::vector<double> values) {
    const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
    std::nth_element(values.begin(), middle, values.end());
    return *middle;
}

void compare_with_reference(Compared& one, const std::vector<measure::Rgb>& reference, std::uint32_t seeds) {
    const std::vector<double> scale = measure::noise_scale(reference);
    one.noise = one.rendering.noise(scale);
    one.relative_variance = measure::mean_interval(one.noise);
    compress::Sum square_error;
    for (std::size_t i = 0; i < scale.size(); ++i) {
        one.relative_variance_of_points.push_back(scale[i] > 0.0 ? one.rendering.variance[i] / scale[i] : 0.0);
        square_error.add(one.rendering.variance[i] / seeds);
    }
    one.median = median_of(one.relative_variance_of_points);
    const double count = static_cast<double>(scale.size());
    const double difference = luminance_mean(one.rendering.mean) - luminance_mean(reference);
    const double standard_error = std::sqrt(square_error.value()) / count;
    one.bias = difference / luminance_mean(reference);
    one.bias_standard_errors = standard_error > 0.0 ? difference / standard_error : 0.0;
}

void count_samples(Compared& one, std::size_t estimates) {
    const measure::Tally& tally = one.rendering.tally;
    if (tally.samples > 0) one.share_above = static_cast<double>(tally.above) / static_cast<double>(tally.samples);
    one.least_share_above = *std::min_element(one.rendering.share_above.begin(), one.rendering.share_above.end());
    one.shadow_rays = static_cast<double>(tally.shadow_rays) / static_cast<double>(estimates);
}

void time_all(Comparison& out, const std::vector<measure::ScenePoint>& points,
              const std::vector<BuiltSampler>& built, const ComparisonOptions& options) {
    std::vector<std::vector<const measure::Estimator*>> estimators;
    for (const BuiltSampler& one : built) estimators.push_back(one.of_material);
    measure::TimingOptions time = options.time;
    time.numbers = options.render.numbers;
    auto times = measure::time_estimates(points, estimators, time);
    for (std::size_t i = 0; i < times.size(); ++i) {
        const measure::Making& making = out.samplers[i].making;
        const double made = (1e9 * making.seconds + options.shadow_ray_ns * double(making.shadow_rays)) /
                            static_cast<double>(points.size());
        for (double& time : times[i]) time += options.shadow_ray_ns * out.samplers[i].shadow_rays + made;
        out.samplers[i].nanoseconds = std::move(times[i]);
    }
}

std::vector<measure::Rgb> mean_of_all(const std::vector<Compared>& samplers) {
    std::vector<measure::Rgb> mean(samplers.front().rendering.mean.size());
    for (const Compared& one : samplers)
        for (std::size_t i = 0; i < mean.size(); ++i)
            for (std::size_t k = 0; k < 3; ++k)
                mean[i][k] += one.rendering.mean[i][k] / static_cast<double>(samplers.size());
    return mean;
}

std::string range_text(const measure::Interval& gain) {
    char text[96];
    std::snprintf(text, sizeof text, "%.3g (%.3g to %.3g)", gain.value, gain.low, gain.high);
    return text;
}

const Compared* best_of(const std::vector<Compared>& samplers, bool ours, Gain gain) {
    const Compared* best = nullptr;
    for (const Compared& one : samplers)
        if (one.ours == ours && one.resolved() && (!best || gain(one, *best).value > 1.0)) best = &one;
    return best;
}

std::string judge(const Comparison& comparison, Gain gain, const char* where, const char* what) {
    const Compared* ours = best_of(comparison.samplers, true, gain);
    const Compared* baseline = best_of(comparison.samplers, false, gain);
    if (!ours || !baseline) {
        const Compared* best = ours ? ours : baseline;
        if (!best)
            return std::string("At equal ") + where + " no sampler can be named best: rare, bright samples decide.";
        return std::string("At equal ") + where + " '" + best->spec.text + "' has the least noise.";
    }
    const bool wins = gain(*ours, *baseline).value >= 1.0;
    const Compared& first = wins ? *ours : *baseline;
    const Compared& second = wins ? *baseline : *ours;
    const measure::Interval factor = gain(first, second);
    std::string text = std::string("At equal ") + where + (wins ? " ours, '" : " a baseline wins: '") +
                       first.spec.text + "'" + (wins ? ", wins: " : ", ") + range_text(factor) + " times less " +
                       what + " than " + (wins ? "the best baseline, '" : "the best of ours, '") +
                       second.spec.text + "'";
    if (factor.low <= 1.0) text += "; within the noise of this run";
    return text + ".";
}

} // namespace

std::unique_ptr<LoadedScene> load_scene(const SceneFile& file, const std::string& data) {
    auto out = std::make_unique<LoadedScene>();
    out->file = file;
    out->probe = load_light(file, data);
    for (const SceneMaterial& material : file.materials) {
        out->brdfs.push_back(input::open_brdf(brdf_source(material.brdf, data)));
        out->scene.materials.push_back({out->brdfs.back().get(), material.tint});
    }
    out->scene.geometry = file.geometry;
    for (const SceneMesh& mesh : file.meshes) {
        const std::string path = (std::filesystem::path(data) / mesh.file).string();
        out->scene.geometry.objects[mesh.object].shape =
            measure::Mesh{std::make_shared<const input::MeshSurface>(input::read_triangles(path, mesh.up))};
    }
    out->scene.camera = file.camera;
    out->scene.width = file.width;
    out->scene.height = file.height;
    out->scene.light = {static_cast<std::uint32_t>(out->probe.width), static_cast<std::uint32_t>(out->probe.height),
                        out->probe.rgb.data(), file.filter};
    if (file.filter != ACDF_FILTER_NEAREST) {
        out->means = texel_means(out->scene.light);
        out->scene.light.means = out->means.data();
    }
    out->points = measure::visible_points(out->scene);
    if (out->points.points.empty()) throw SceneError("camera: no object is in view");
    return out;
}

measure::Interval gain_at_equal_samples(const Compared& a, const Compared& b) {
    return &a == &b ? measure::Interval{1.0, 1.0, 1.0} : measure::ratio_interval(b.noise, a.noise);
}

measure::Interval gain_at_equal_time(const Compared& a, const Compared& b) {
    if (&a == &b) return {1.0, 1.0, 1.0};
    return measure::product(gain_at_equal_samples(a, b), measure::ratio_interval(b.nanoseconds, a.nanoseconds));
}

Comparison compare(const measure::Scene& scene, const std::vector<measure::ScenePoint>& points,
                   SamplerBuilder& builder, const ComparisonOptions& options, const build::Progress& progress,
                   std::vector<measure::Rgb> reference) {
    const auto tell = [&](double fraction, const char* what) {
        if (progress) progress(fraction, what);
    };
    Comparison out;
    std::vector<BuiltSampler> built;
    for (const SamplerSpec& spec : options.samplers) {
        tell(0.2 * static_cast<double>(built.size()) / static_cast<double>(options.samplers.size()), "building");
        built.push_back(builder.build(spec, options.samples));
    }
    out.reference = std::move(reference);
    if (options.reference && out.reference.empty())
        out.reference =
            measure::reference(scene.light, points, [&](double share) { tell(0.2 + 0.4 * share, "summing"); });
    for (std::size_t i = 0; i < built.size(); ++i) {
        tell(0.6 + 0.3 * static_cast<double>(i) / static_cast<double>(built.size()), "rendering");
        Compared one;
        one.spec = options.samplers[i];
        one.ours = built[i].ours;
        one.bytes = built[i].bytes;
        one.build_seconds = built[i].build_seconds;
        one.making = built[i].making;
        one.scales =
            options.render.numbers == measure::Numbers::independent && one.spec.kind != SamplerKind::strata;
        one.rendering = measure::render(points, built[i].of_material, one.spec.text, options.render);
        count_samples(one, points.size() * options.render.seeds);
        out.samplers.push_back(std::move(one));
    }
    if (out.reference.empty()) out.reference = mean_of_all(out.samplers);
    for (Compared& one : out.samplers) compare_with_reference(one, out.reference, options.render.seeds);
    for (const measure::ScenePoint& point : points)
        out.sky_hidden += point.share_hidden() / static_cast<double>(points.size());
    tell(0.9, "timing");
    if (options.timing) time_all(out, points, built, options);
    for (Compared& one : out.samplers) {
        one.equal_samples = gain_at_equal_samples(one, out.samplers.front());
        if (options.timing) one.equal_time = gain_at_equal_time(one, out.samplers.front());
    }
    return out;
}

std::vector<std::string> verdict(const Comparison& comparison, bool timed) {
    std::vector<std::string> out{judge(comparison, gain_at_equal_samples, "samples", "variance")};
    if (timed) out.push_back(judge(comparison, gain_at_equal_time, "time", "variance"));
    return out;
}

namespace {

bool resolved(const Comparison& hidden, const Comparison& open, std::size_t i) {
    return hidden.samplers[i].resolved() && open.samplers[i].resolved();
}

} // namespace

std::vector<Overtaking> overtakings(const Comparison& hidden, const Comparison& open, Gain gain) {
    std::vector<Overtaking> out;
    for (std::size_t a = 0; a < hidden.samplers.size(); ++a)
        for (std::size_t b = 0; b < hidden.samplers.size(); ++b)
            if (a != b && resolved(hidden, open, a) && resolved(hidden, open, b) &&
                gain(hidden.samplers[a], hidden.samplers[b]).low > 1.0 &&
                gain(open.samplers[b], open.samplers[a]).low > 1.0)
                out.push_back({&hidden.samplers[a], &hidden.samplers[b]});
    return out;
}

} // namespace acdf::tools
