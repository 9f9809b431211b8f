// The sweep of environment files.
#include "build/accuracy/local.h"
#include "build/own_terms.h"
#include "measure/samplers/full_cdf.h"
#include "tools/cli/built.h"
#include "tools/plot/knots.h"
#include "tools/plot/pdf_image.h"
#include "tools/sweep/baselines.h"
#include "tools/sweep/build.h"
#include "tools/sweep/occluders.h"
#include "tools/sweep/surface.h"
#include "tools/sweep/surface_samples.h"

#include <algorithm>
#include <cmath>

namespace acdf::tools {
namespace {

builder::EnvironmentOptions options_of(const Step& step, const builder::Target& target) {
    builder::EnvironmentOptions out;
    const std::uint32_t cells = cells_in(step.budget);
    if (step.fit == "variance") {
        out.goal = builder::Goal::of_budget(step.budget);
    } else {
        out.fit.fit = step.fit == "cdf" ? ACDF_FIT_CDF : step.fit == "pdf" ? ACDF_FIT_PDF : ACDF_FIT_UNIFORM;
        const auto side = static_cast<std::uint32_t>(std::max(2.0, std::sqrt(cells)));
        out.fit.phi_segments = std::min(side, target.columns());
        out.fit.theta_segments = std::min(side, target.rows());
    }
    return out;
}

std::string text_of(const Step& step, const builder::EnvironmentOptions& o) {
    if (step.fit == "variance") return "--budget " + budget_text(step.budget);
    return "--fit " + step.fit + " " + knots_text(o.fit.phi_segments, o.fit.theta_segments);
}

const char* environment_label(const std::string& fit) {
    return fit == "variance" ? "variance fit (default)"
           : fit == "cdf"    ? "cdf fit (the paper's)"
           : fit == "pdf"    ? "pdf fit"
                             : "uniform knots";
}

Candidate make_file(const builder::Target& target, const builder::Source& source, const Step& step) {
    builder::EnvironmentOptions options = options_of(step, target);
    options.source = source;
    builder::Environment made;
    throw_unless_built(builder::environment(target, options, made));
    Candidate out = file_candidate(std::move(made.bytes));
    out.row.label = environment_label(step.fit);
    out.row.options = text_of(step, options);
    out.row.cells = made.accuracy.cells;
    out.row.relative_variance = made.accuracy.support_violations > 0 ? HUGE_VAL : made.accuracy.relative_variance;
    out.row.max_weight = made.accuracy.max_weight;
    out.row.rms = made.accuracy.rms_pdf_error;
    return out;
}

void add_pictures(Sweep& sweep, const compress::Target& target, const std::vector<Candidate>& candidates) {
    const build::Map map = plot_map(build::Layout::latlong, kPictureWidth);
    const PdfImage full = pdf_image(map, pdf_of(target));
    sweep.range = automatic_range(full);
    add_colour_bar(sweep);
    add_picture(sweep, full, {}, {}, "The probe itself, full resolution",
                "The probe's own pdf in false colour, as a lat-long map.");
    for (std::size_t i : pictured(candidates, sweep)) {
        const EnvironmentView view = candidates[i].file->file.environment();
        add_picture(sweep, pdf_image(map, pdf_of(view)), knot_opacity(view, map), {},
                    picture_title(candidates[i].row),
                    "The pdf that this file stores, in the same colours, with the borders of its cells.");
    }
}

/// `out`: alone, and with an MIS partner.
void add_situations(const compress::Target& target, const measure::LightSampler& sampler,
                    const std::vector<float>& pdf, const std::vector<SurfacePoint>& points, Scale scale,
                    const SweepOptions& options, Lit* out) {
    const measure::MapLight light = map_light(target, options);
    const std::vector<PointVariance> exact = point_variances(target, pdf, points);
    const SurfaceVariances variances = summary(exact, scale);
    const SampledVariances sampled =
        sobol_variances(target, light, sampler, points, exact, scale, options.visible.spp, options.seeds);
    out[0] = variances.alone;
    out[1] = variances.partner;
    out[0].sobol = std::isinf(out[0].mean) ? HUGE_VAL : sampled.alone;
    out[1].sobol = sampled.partner;
}

} // namespace

Sweep sweep_environment(const builder::Target& fitted, const builder::Source& source, const SweepOptions& options,
                        const build::Progress& progress) {
    compress::Target map;
    const compress::Target& target = compress::of_texels(builder::grid_of(fitted), map);
    Sweep sweep;
    sweep.kind = SweepKind::environment;
    take_options(sweep, options);
    const auto part = [&](double begin, double width) { return part_of(progress, begin, width); };
    std::vector<Candidate> candidates;
    build_all(
        sweep, candidates, steps_of(sweep.kind, options),
        [&](const Step& step) { return make_file(fitted, source, step); }, part(0.0, 0.7));

    sweep.reference = candidates.size();
    for (Candidate& baseline : environment_baselines(target, builder::grid_of(fitted).peaks, options))
        candidates.push_back(std::move(baseline));
    const std::vector<SurfacePoint> open = in_the_open(build::random_normals(options.normals)),
                                    hidden = behind_occluders(target, options.points);
    sweep.conditions = static_cast<std::uint32_t>(open.size());
    for (std::size_t i = 0; i < candidates.size(); ++i) {
        part(0.7, 0.2)(static_cast<double>(i) / static_cast<double>(candidates.size()), "measuring");
        const measure::LightSampler& sampler = *candidates[i].sampler;
        const std::vector<float> pdf = texel_pdfs(target, sampler);
        SweepRow& row = candidates[i].row;
        add_situations(target, sampler, pdf, open, Scale::own, options, &row.lit[open_alone]);
        add_situations(target, sampler, pdf, hidden, Scale::picture, options, &row.lit[hidden_alone]);
    }
    if (options.pictures) add_pictures(sweep, target, candidates);
    finish_rows(sweep, std::move(candidates), timed_points(), options, part(0.9, 0.1));
    return sweep;
}

} // namespace acdf::tools
