// The sweep of files with visibility cells: on a mesh, with what it hides.
#include "build/own_terms.h"
#include "measure/scenes/mesh_stage.h"
#include "tools/cli/built.h"
#include "tools/commands.h"
#include "tools/sweep/baselines.h"
#include "tools/sweep/build.h"
#include "tools/sweep/surface.h"

#include <algorithm>
#include <cmath>

namespace acdf::tools {
namespace {

Candidate make_file(const builder::Target& target, const builder::Source& source, const SweptMesh& mesh,
                    const Step& step) {
    const bool visibility = step.fit == "visibility";
    builder::LocalOptions options;
    options.goal = builder::Goal::of_budget(step.budget);
    options.source = source;
    if (visibility) {
        options.visibility = mesh.visibility;
        options.normals = mesh.normals;
        options.normals_text = mesh.text;
    }
    builder::Local made;
    throw_unless_built(builder::local(target, options, made));
    Candidate out = file_candidate(std::move(made.bytes));
    out.row.label = visibility ? "visibility" : "by normals alone";
    out.row.options = (visibility ? mesh.options + " --visibility " : "") + "--budget " + budget_text(step.budget);
    return out;
}

/// Measures variances of each file and baseline at the same points.
void measure_on(const measure::MeshStage& stage, std::vector<Candidate>& candidates, Sweep& sweep,
                const build::Progress& progress) {
    std::vector<const measure::LightSampler*> samplers;
    for (const Candidate& each : candidates) samplers.push_back(each.sampler.get());
    const measure::StageVariances found =
        measure::variances_on(stage, samplers, [&](double share) { progress(share, "measuring"); });
    sweep.conditions = static_cast<std::uint32_t>(found.of_points.front().size());
    if (sweep.conditions == 0) throw Failure("no point of the scene sees any light");
    for (std::size_t i = 0; i < candidates.size(); ++i) {
        const Lit lit = found.lost[i] > 0 ? Lit{HUGE_VAL, HUGE_VAL, HUGE_VAL} : spread_of(found.of_points[i]);
        candidates[i].row.relative_variance = lit.mean;
        candidates[i].row.median = lit.median;
        candidates[i].row.worst = lit.worst;
    }
}

} // namespace

Sweep sweep_visibility(const builder::Target& fitted, const builder::Source& source, const SweptMesh& mesh,
                       const SweepOptions& options, const build::Progress& progress) {
    compress::Target map;
    const compress::Target& target = compress::of_texels(builder::grid_of(fitted), map);
    Sweep sweep;
    sweep.kind = SweepKind::visibility;
    take_options(sweep, options);
    const auto part = [&](double begin, double width) { return part_of(progress, begin, width); };
    std::vector<Candidate> candidates;
    build_all(
        sweep, candidates, steps_of(sweep.kind, options),
        [&](const Step& step) { return make_file(fitted, source, mesh, step); }, part(0.0, 0.7));
    sweep.reference = candidates.size();
    for (Candidate& baseline : local_baselines(target, {}))
        if (baseline.has_pdf) candidates.push_back(std::move(baseline)); // else there is nothing to sum
    const measure::MeshStage stage(mesh.surface, mesh.turned, target, options.normals);
    measure_on(stage, candidates, sweep, part(0.7, 0.2));
    std::vector<measure::ShadingPoint> points;
    for (const measure::ScenePoint& point : stage.points()) points.push_back(point.shading());
    finish_rows(sweep, std::move(candidates), points, options, part(0.9, 0.1));
    return sweep;
}

} // namespace acdf::tools
