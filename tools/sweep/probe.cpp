// The sweep of a probe: files of all kinds, in a path tracer's estimate.
#include "build/accuracy/local.h"
#include "build/own_terms.h"
#include "measure/scenes/mesh_stage.h"
#include "tools/commands.h"
#include "tools/plot/knots.h"
#include "tools/plot/local.h"
#include "tools/plot/pdf_image.h"
#include "tools/sweep/baselines.h"
#include "tools/sweep/build.h"
#include "tools/sweep/estimator.h"
#include "tools/sweep/files.h"
#include "tools/sweep/renderers.h"

#include <algorithm>
#include <cmath>
#include <optional>

namespace acdf::tools {
namespace {

std::vector<Step> steps_of(const SweepOptions& options, bool mesh) {
    std::vector<Step> out;
    for (const std::string& file : options.files.empty() ? default_files(mesh) : options.files)
        for (std::uint64_t budget : options.budgets.empty() ? file_kind(file).budgets : options.budgets)
            out.push_back({file, budget});
    return out;
}

/// Of maps larger than half a million texels fewer points, since each looks at all of them.
std::uint32_t point_count(const SweepOptions& options, const compress::Target& target) {
    const double share = std::min(1.0, double(1u << 19) / static_cast<double>(target.values.size()));
    return std::max(std::min(options.points, 8u), static_cast<std::uint32_t>(options.points * share));
}

/// So many at a time that their pdfs of all texels take at most 64 MiB.
void measure_all(Sweep& sweep, std::vector<Candidate>& candidates, const compress::Target& target,
                 const std::vector<SurfacePoint>& points, const SweepOptions& options,
                 const build::Progress& progress) {
    const std::size_t at_once = std::max<std::size_t>(1, (std::size_t{1} << 24) / target.values.size());
    const measure::MapLight light = map_light(target, options);
    for (std::size_t first = 0; first < candidates.size(); first += at_once) {
        progress(static_cast<double>(first) / static_cast<double>(candidates.size()), "measuring");
        const std::size_t count = std::min(at_once, candidates.size() - first);
        std::vector<SamplerAtPoints> samplers;
        for (std::size_t k = 0; k < count; ++k)
            samplers.push_back({candidates[first + k].sampler.get(), candidates[first + k].row.needs});
        const auto exact = point_variances(target, samplers, points, options.heuristic);
        for (std::size_t k = 0; k < count; ++k) {
            const auto sums = relative_variances(exact[k]),
                       sobol = relative_variances(sobol_variances(light, *samplers[k].sampler, points, exact[k],
                                                                  options.heuristic, options.visible.spp,
                                                                  options.seeds));
            for (std::size_t e = 0; e < kEstimators; ++e)
                for (std::size_t c = 0; c < kCases; ++c)
                    candidates[first + k].row.noise[e][c] = {sums[e][c], sobol[e][c]};
        }
    }
    sweep.conditions = static_cast<std::uint32_t>(points.size());
}

void add_light_picture(Sweep& sweep, const compress::Target& target) {
    const PdfImage full = pdf_image(plot_map(build::Layout::latlong, kPictureWidth), pdf_of(target));
    sweep.range = automatic_range(full);
    add_colour_bar(sweep);
    add_picture(sweep, full, {}, {}, "The probe itself, full resolution",
                "The probe's own pdf in false colour, latitude and longitude.");
}

/// The source, and the largest file of each kind that is compared.
void add_pictures(Sweep& sweep, const compress::Target& target, const std::vector<Candidate>& candidates) {
    add_light_picture(sweep, target);
    const PlotMap map = plot_map(build::Layout::latlong, kPictureWidth);
    const Normal normal = {1.0f, 0.0f, 1.0f};
    for (std::size_t i : largest_of_each_kind(candidates)) {
        const Candidate& one = candidates[i];
        if (one.row.needs == Given::position) continue;
        if (one.row.needs == Given::nothing) {
            const EnvironmentView view = one.file->file.environment();
            add_picture(sweep, pdf_image(map, pdf_of(view)), knot_opacity(view, map), {}, picture_title(one.row),
                        "The pdf that this file stores, with the borders of its cells.");
        } else {
            const PlottedNormal plotted{VisibleLocalView(one.file->file.local()), normal};
            add_picture(sweep, pdf_image(map, pdf_of(plotted)), knot_opacity(plotted, map),
                        horizon_opacity(normal, map), picture_title(one.row) + ", normal (1, 0, 1)",
                        "The pdf that this file has for the normal (1, 0, 1), with the borders of its cells; the "
                        "white line is the horizon.");
        }
    }
}

} // namespace

Sweep sweep_probe(const builder::Target& fitted, const builder::Source& source, const SweptMesh* mesh,
                  const SweepOptions& options, const build::Progress& progress) {
    compress::Target map;
    const compress::Target& target = compress::of_texels(builder::grid_of(fitted), map);
    Sweep sweep;
    take_options(sweep, options);
    sweep.on_mesh = mesh != nullptr;
    const auto part = [&](double begin, double width) { return part_of(progress, begin, width); };
    const std::vector<Step> steps = steps_of(options, sweep.on_mesh);
    std::vector<Candidate> candidates;
    build_all(
        sweep, candidates, steps,
        [&](const Step& step) { return make_file(step, fitted, source, mesh, options.heuristic); }, part(0.0, 0.6));

    sweep.reference = candidates.size();
    for (Candidate& baseline : probe_baselines(target, builder::grid_of(fitted).peaks, file_kind("env").budgets))
        candidates.push_back(std::move(baseline));
    std::optional<measure::MeshStage> stage;
    if (mesh) stage.emplace(mesh->surface, mesh->turned, target, point_count(options, target));
    const std::vector<SurfacePoint> points =
        mesh ? mesh_points(stage->points()) : half_hidden_points(point_count(options, target));
    measure_all(sweep, candidates, target, points, options, part(0.6, 0.3));
    if (options.pictures) add_pictures(sweep, target, candidates);
    std::vector<measure::ShadingPoint> timed;
    for (const SurfacePoint& point : mesh ? points : half_hidden_points(4096)) timed.push_back(point.shading);
    finish_rows(sweep, std::move(candidates), timed, options, part(0.9, 0.1));
    return sweep;
}

} // namespace acdf::tools
