// The sweep of local environment files.
#include "tools/plot/local.h"
#include "build/accuracy/texel_cosines.h"
#include "build/own_terms.h"
#include "compress/sum.h"
#include "tools/cli/built.h"
#include "tools/plot/pdf_image.h"
#include "tools/sweep/baselines.h"
#include "tools/sweep/build.h"
#include "tools/sweep/surface.h"
#include "tools/sweep/surface_samples.h"

#include <algorithm>
#include <cmath>

namespace acdf::tools {
namespace {

/// The paper's bins of normals (Lawrence et al. 2005, §7.1).
constexpr std::uint32_t kPaperColumns = 25, kPaperRows = 10;

builder::LocalOptions options_of(const Step& step) {
    builder::LocalOptions out;
    out.goal = builder::Goal::of_budget(step.budget);
    out.shape = step.fit == "fast" ? builder::LocalShape::fast : builder::LocalShape::small;
    out.sharing = step.fit == "variance" || step.fit == "fast";
    if (step.fit != "cdf") return out;
    out.columns = kPaperColumns, out.rows = kPaperRows;
    out.fit.fit = ACDF_FIT_CDF;
    out.fit.order = builder::Order::z;
    const double cells = double(cells_in(step.budget)) / (kPaperColumns * kPaperRows);
    out.fit.phi_segments = out.fit.theta_segments =
        static_cast<std::uint32_t>(std::max(2.0, std::round(std::sqrt(cells))));
    return out;
}

std::string text_of(const Step& step, const builder::LocalOptions& o) {
    if (step.fit == "variance") return "--shape small --budget " + budget_text(step.budget);
    if (step.fit == "fast") return "--shape fast --budget " + budget_text(step.budget);
    if (step.fit == "separate") return "--no-sharing --budget " + budget_text(step.budget);
    return "--no-sharing --normals 25x10 --fit cdf " + knots_text(o.fit.phi_segments, o.fit.theta_segments);
}

const char* local_label(const std::string& fit) {
    return fit == "variance"   ? "the small shape"
           : fit == "fast"     ? "the fast shape"
           : fit == "separate" ? "a tree for each normal"
                               : "the paper's: 25 x 10 normals, cdf fit";
}

Candidate make_file(const builder::Target& target, const builder::Source& source,
                    const std::vector<build::Normal>& normals, const Step& step) {
    builder::LocalOptions options = options_of(step);
    options.source = source;
    builder::Local made;
    throw_unless_built(builder::local(target, options, made));
    Candidate out = file_candidate(std::move(made.bytes));
    const build::LocalAccuracy accuracy =
        build::summary(build::measure_normals(out.file->file, builder::grid_of(target), normals));
    out.row.label = local_label(step.fit);
    out.row.options = text_of(step, options);
    out.row.cells = 0;
    out.row.relative_variance = accuracy.support_violations > 0 ? HUGE_VAL : accuracy.relative_variance;
    out.row.worst = accuracy.support_violations > 0 ? HUGE_VAL : accuracy.worst;
    out.row.median = accuracy.median;
    out.row.max_weight = accuracy.max_weight;
    return out;
}

/// What a surface sees of the target, at full resolution: the pdf that all samplers approach.
PdfFunction reflected_pdf(const compress::Target& target, const Normal& n) {
    const PdfFunction light = pdf_of(target);
    const double length = std::hypot(double{n[0]}, double{n[1]}, double{n[2]});
    compress::Sum sum;
    const build::TexelCosines cosines(target);
    const float unit[3] = {static_cast<float>(n[0] / length), static_cast<float>(n[1] / length),
                           static_cast<float>(n[2] / length)};
    const double flux = compress::integral(target);
    for (std::uint32_t r = 0; r < target.rows; ++r)
        cosines.for_each_above(unit, r, [&](std::uint32_t c, double cosine) {
            sum.add(double{target.row(r)[c]} / flux * cosine * target.column_measure[c] * target.row_measure[r]);
        });
    const double scale = sum.value() > 0.0 ? 1.0 / sum.value() : 0.0;
    return [light, scale, unit = std::array<float, 3>{unit[0], unit[1], unit[2]}](const float d[3]) {
        const float cosine = unit[0] * d[0] + unit[1] * d[1] + unit[2] * d[2];
        return static_cast<float>(double{light(d)} * std::max(0.0f, cosine) * scale);
    };
}

void add_local_pictures(Sweep& sweep, const compress::Target& target, const std::vector<Candidate>& candidates) {
    const Normal normal = {1.0f, 0.0f, 1.0f};
    const build::Map map = plot_map(build::Layout::latlong, kPictureWidth);
    const PdfImage full = pdf_image(map, reflected_pdf(target, normal));
    sweep.range = automatic_range(full);
    add_colour_bar(sweep);
    const std::vector<float> horizon = horizon_opacity(normal, map);
    add_picture(sweep, full, {}, horizon, "Light times cosine, full resolution, for a normal half-way up (1, 0, 1)",
                "What a diffuse surface reflects of the probe, in false colour; the white line is its horizon.");
    for (std::size_t i : pictured(candidates, sweep)) {
        const PlottedNormal plotted{candidates[i].file->file.local(), normal};
        add_picture(
            sweep, pdf_image(map, pdf_of(plotted)), knot_opacity(plotted, map), horizon,
            picture_title(candidates[i].row),
            "The pdf of this file for the same normal, in the same colours, with the borders of its cells.");
    }
}

/// Files and baselines with a renderer's points; not where those sample numbers of their own.
void add_sobol(const compress::Target& target, const std::vector<build::Normal>& normals,
               const SweepOptions& options, std::vector<Candidate>& candidates) {
    const std::vector<SurfacePoint> points = in_the_open(normals);
    const measure::MapLight light = map_light(target, options);
    const std::vector<float> anything(target.values.size(), 1.0f);
    std::vector<double> irradiances;
    for (const PointVariance& point : point_variances(target, anything, points))
        irradiances.push_back(point.irradiance);
    for (Candidate& each : candidates)
        if (each.has_pdf && std::isfinite(each.row.relative_variance))
            each.row.sobol = sobol_variance(target, light, *each.sampler, points, irradiances, options.visible.spp,
                                            options.seeds);
}

} // namespace

Sweep sweep_local(const builder::Target& fitted, const builder::Source& source, const SweepOptions& options,
                  const build::Progress& progress) {
    compress::Target map;
    const compress::Target& target = compress::of_texels(builder::grid_of(fitted), map);
    Sweep sweep;
    sweep.kind = SweepKind::local;
    take_options(sweep, options);
    const auto part = [&](double begin, double width) { return part_of(progress, begin, width); };
    const std::vector<build::Normal> normals = build::random_normals(options.normals);
    sweep.conditions = static_cast<std::uint32_t>(normals.size());
    std::vector<Candidate> candidates;
    build_all(
        sweep, candidates, steps_of(sweep.kind, options),
        [&](const Step& step) { return make_file(fitted, source, normals, step); }, part(0.0, 0.8));
    part(0.8, 0.0)(0.0, "measuring baselines");
    sweep.reference = candidates.size();
    for (Candidate& baseline : local_baselines(target, normals)) candidates.push_back(std::move(baseline));
    part(0.85, 0.0)(0.0, "plotting");
    add_sobol(target, normals, options, candidates);
    if (options.pictures) add_local_pictures(sweep, target, candidates);
    finish_rows(sweep, std::move(candidates), timed_points(), options, part(0.9, 0.1));
    return sweep;
}

} // namespace acdf::tools
