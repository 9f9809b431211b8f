#include "tools/measure/local.h"

#include "tools/cli/json.h"
#include "tools/cli/messages.h"
#include "tools/cli/source_check.h"

#include "build/accuracy/cells.h"
#include "build/accuracy/environment.h"
#include "build/accuracy/fine_texels.h"
#include "build/accuracy/local.h"
#include "build/local.h"
#include "compress/parallel.h"
#include "measure/samplers/light_samplers.h"
#include "measure/samplers/local_baselines.h"
#include "measure/samplers/tiling.h"
#include "measure/scenes/mesh_stage.h"
#include "tools/cli/noise.h"
#include "tools/cli/probe_source.h"
#include "tools/commands.h"
#include "tools/measure/memory.h"
#include "visibility/visible_view.h"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <cinttypes>
#include <cstdio>
#include <functional>
#include <memory>
#include <optional>

namespace acdf::tools {
namespace {

/// Another way to estimate irradiance: mean relative variance of a sample, and what it keeps in memory.
struct Baseline {
    const char* key;
    const char* text;
    double relative_variance = 0.0;
    std::uint64_t bytes = 0;
};

constexpr std::uint32_t kCandidates = 32;

/// Of a map; `columns` and `rows` tiles.
struct LocalBaselines {
    measure::LocalFullCdf full;
    measure::Resampling resampling;
    measure::TilingOnTheFly tiling;
    measure::CosineHemisphere cosine;

    LocalBaselines(const compress::Target& target, std::uint32_t columns, std::uint32_t rows)
        : full(target), resampling(target, kCandidates), tiling(target, columns, rows), cosine(target) {}
};

/// Their noise is summed as that of the file is.
std::vector<Baseline> baselines_of(const compress::Target& target, const std::vector<build::Normal>& normals) {
    const std::uint32_t columns = std::min(32u, target.columns), rows = std::min(16u, target.rows);
    const build::FineTexels texels(target);
    const LocalBaselines made(target, columns, rows);
    std::optional<LocalBaselines> divided;
    if (&texels.target() != &target) divided.emplace(texels.target(), columns, rows);
    const LocalBaselines& summed = divided ? *divided : made;
    const auto mean = [&](const std::function<double(const float*)>& variance) {
        std::vector<double> each(normals.size());
        compress::parallel_for(std::size_t{0}, normals.size(),
                               [&](std::size_t i) { each[i] = variance(normals[i].data()); });
        double sum = 0.0;
        for (double v : each) sum += v;
        return sum / double(normals.size());
    };
    const auto of = [&](const auto& baseline) {
        return mean([&baseline](const float* n) { return baseline.relative_variance(n); });
    };
    return {{"full_cdf", "full-resolution CDF", of(summed.full), made.full.bytes()},
            {"resampling_32", "resampling 32 candidates", of(summed.resampling), made.resampling.bytes()},
            {"tiling_512", "512 tiles x cosine on the fly", of(summed.tiling), made.tiling.bytes()},
            {"cosine", "cosine hemisphere", of(summed.cosine), made.cosine.bytes()}};
}

std::uint64_t count_cells(const File& file) {
    std::uint64_t cells = 0;
    const auto count = [&](const build::Cell&) { ++cells; };
    const std::vector<std::array<AcdfRange, 2>> boxes = build::tile_boxes(file);
    for (std::uint32_t t = 0; t < boxes.size(); ++t) build::for_each_tile_cell(file, t, count);
    for (std::uint32_t b = 0; boxes.empty() && b < file.description().bin_count; ++b)
        if (file.bin(b).root != ACDF_NO_ROOT) build::for_each_cell(file, file.bin(b).root, count);
    return cells;
}

/// As many normals as are asked for: of the scene, as often as they occur in it, where that says no more of a file.
std::vector<build::Normal> normals_of(const LocalMeasureOptions& options, bool of_scene) {
    if (!of_scene) return build::random_normals(options.normals);
    std::vector<compress::SceneNormal> scene;
    for (const input::WeightedNormal& found : input::read_scene_normals(options.mesh, {options.up, false}).normals)
        scene.push_back({{found.n[0], found.n[1], found.n[2]}, found.weight});
    return build::test_normals(scene, options.normals);
}

/// Over points of a mesh that see any light.
struct VisibilityAccuracy {
    std::size_t points = 0; ///< 0: not measured
    double relative_variance = 0.0, worst = 0.0;
    double normals_alone = 0.0; ///< of the same file, without its visibility cells
    std::uint64_t support_violations = 0;
};

VisibilityAccuracy measure_visibility(const File& file, const LocalMeasureOptions& options,
                                      const compress::Target& target) {
    auto surface = std::make_shared<const input::MeshSurface>(input::read_triangles(options.mesh, options.up));
    const measure::MeshStage stage(std::move(surface), options.up == input::UpAxis::y, target, options.points);
    const auto with = measure::file_sampler(file), without = measure::normals_alone_sampler(file);
    const measure::StageVariances found = measure::variances_on(stage, {with.get(), without.get()});
    VisibilityAccuracy out;
    out.points = found.of_points[0].size();
    out.support_violations = found.lost[0];
    if (out.points == 0) throw Failure(options.mesh + ": no point of it sees any light");
    for (std::size_t i = 0; i < out.points; ++i) {
        out.relative_variance += found.of_points[0][i] / double(out.points);
        out.normals_alone += found.of_points[1][i] / double(out.points);
        out.worst = std::max(out.worst, found.of_points[0][i]);
    }
    return out;
}

/// How many times as much a baseline has; 1 where neither has any.
double times(double baseline, double own) { return baseline <= own && own <= baseline ? 1.0 : baseline / own; }

nlohmann::ordered_json visibility_json(const VisibilityAccuracy& p) {
    return {{"points", p.points},
            {"relative_variance", p.relative_variance},
            {"relative_variance_worst", p.worst},
            {"relative_variance_normals_alone", p.normals_alone},
            {"gain", times(p.normals_alone, p.relative_variance)},
            {"support_violations", p.support_violations}};
}

void print_visibility(const VisibilityAccuracy& p) {
    std::printf("  at %zu positions of the scene, with its occluders\n", p.points);
    std::printf("    relative variance    %.6g; %.6g at worst\n", p.relative_variance, p.worst);
    std::printf("    by normals alone     %.6g   %.4g times as much\n", p.normals_alone,
                times(p.normals_alone, p.relative_variance));
    std::printf("    support violations   %" PRIu64 "\n", p.support_violations);
}

/// What is printed.
struct LocalMeasured {
    build::LocalAccuracy normals;
    build::Accuracy whole; ///< for points without a normal
    std::vector<Baseline> baselines;
    VisibilityAccuracy visibility;
};

nlohmann::ordered_json report(const File& file, const LocalMeasureOptions& options, const LocalMeasured& measured) {
    const build::LocalAccuracy& a = measured.normals;
    const build::Accuracy& whole = measured.whole;
    nlohmann::ordered_json out = {
        {"file", options.file},
        {"source", options.source},
        {"normals", a.lit_normals},
        {"relative_variance", a.relative_variance}, // JSON has no infinity: null with a support violation
        {"noise_percent", noise_json(a.relative_variance)},
        {"relative_variance_median", a.median},
        {"relative_variance_worst", a.worst},
        {"relative_variance_full_cdf", a.relative_variance_full_cdf},
        {"gain", times(a.relative_variance_full_cdf, a.relative_variance)},
        {"share_above_horizon", a.share_above_horizon},
        {"least_share_above_horizon", a.least_share_above_horizon},
        {"share_above_horizon_full_cdf", a.share_above_horizon_full_cdf},
        {"least_share_above_horizon_full_cdf", a.least_share_above_horizon_full_cdf},
        {"max_weight", a.max_weight},
        {"support_violations", a.support_violations},
        {"bytes", file.size()},
        {"memory_bytes", measure::memory_of(file)},
        {"cells", count_cells(file)},
        {"bins", file.description().bin_count},
        {"total", file.description().total},
        {"environment",
         {{"relative_variance", whole.relative_variance},
          {"max_weight", whole.max_weight},
          {"support_violations", whole.support_violations},
          {"cells", whole.cells}}}};
    if (a.combined) out["combined"] = true; // of the file and its partner
    for (const Baseline& baseline : measured.baselines)
        out["baselines"][baseline.key] = {{"relative_variance", baseline.relative_variance},
                                          {"bytes", baseline.bytes}};
    if (measured.visibility.points > 0) out["visibility"] = visibility_json(measured.visibility);
    return out;
}

void print_text(const File& file, const LocalMeasureOptions& options, const LocalMeasured& measured) {
    const build::LocalAccuracy& a = measured.normals;
    const VisibilityAccuracy& visibility = measured.visibility;
    std::printf("%s against %s, %u %s\n", printable(options.file).c_str(), printable(options.source).c_str(),
                a.lit_normals,
                options.mesh.empty() || visibility.points > 0 ? "random normals" : "normals of the scene");
    std::printf("  relative variance      %.6g   %s\n", a.relative_variance,
                a.combined ? "a sample of the irradiance, with its MIS partner: not to be used alone"
                           : "of one sample of the irradiance, mean over normals");
    std::printf("    noise                %s   at 16, 64, 256 samples, without occluders\n",
                noise_texts(a.relative_variance).c_str());
    std::printf("    median, worst        %.6g, %.6g\n", a.median, a.worst);
    std::printf("    full-resolution CDF  %.6g   %.4g times as much\n", a.relative_variance_full_cdf,
                times(a.relative_variance_full_cdf, a.relative_variance));
    std::printf("  above the horizon      %.2f %%   of samples; %.2f %% for the worst normal\n",
                100.0 * a.share_above_horizon, 100.0 * a.least_share_above_horizon);
    std::printf("    full-resolution CDF  %.2f %%; %.2f %%\n", 100.0 * a.share_above_horizon_full_cdf,
                100.0 * a.least_share_above_horizon_full_cdf);
    std::printf("  largest weight         %.6g   f/p over its mean\n", a.max_weight);
    std::printf("  support violations     %" PRIu64 "\n", a.support_violations);
    std::printf("  cells                  %" PRIu64 "\n", count_cells(file));
    std::printf("  without a normal       %.6g   relative variance of environment(), used alone\n",
                measured.whole.relative_variance);
    std::printf("    largest weight       %.6g\n", measured.whole.max_weight);
    print_bytes(file);
    for (const Baseline& baseline : measured.baselines)
        std::printf("  %-30s relative variance %.6g, %" PRIu64 " bytes\n", baseline.text,
                    baseline.relative_variance, baseline.bytes);
    if (visibility.points > 0) print_visibility(visibility);
}

} // namespace

void measure_local(const File& file, const LocalMeasureOptions& options) {
    const bool mesh = !options.mesh.empty() && visible_view(file).has_cells();
    if (mesh && file.partner()) throw Failure(options.file + ": is made for an MIS partner; leave out --scene");
    const ProbeTarget source =
        source_target(options.file, file, options.source, options.input, options.quiet, options.filter);
    const std::vector<build::Normal> normals = normals_of(options, !mesh && !options.mesh.empty());
    LocalMeasured measured;
    measured.normals = build::summary(build::measure_normals(file, builder::grid_of(source.target), normals));
    measured.whole = build::measure_whole(file, builder::grid_of(source.target));
    compress::Target map;
    if (options.baselines)
        measured.baselines = baselines_of(compress::of_texels(builder::grid_of(source.target), map), normals);
    if (mesh) { // whose points see lat-long texels
        const bool square = builder::grid_of(source.target).parameterization == ACDF_PARAM_OCTAHEDRAL;
        const builder::Target light =
            square ? latlong_target(file, options.source, options.input, options.filter).target : source.target;
        measured.visibility = measure_visibility(file, options, compress::of_texels(builder::grid_of(light), map));
    }
    if (options.json) std::fputs(json_text(report(file, options, measured)).c_str(), stdout);
    else print_text(file, options, measured);
    require_support(options.file, file, options.source, source.probe.source_sha256,
                    measured.normals.support_violations + measured.whole.support_violations +
                        measured.visibility.support_violations);
}

} // namespace acdf::tools
