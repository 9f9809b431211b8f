// The sweep of BRDF files.
#include "build/brdf.h"
#include "build/own_terms.h"
#include "input/brdf/rgl.h"
#include "measure/samplers/brdf_table.h"
#include "measure/samplers/light_samplers.h"
#include "measure/samplers/point_samplers.h"
#include "measure/samplers/rgl_sampler.h"
#include "tools/cli/built.h"
#include "tools/plot/brdf.h"
#include "tools/plot/knots.h"
#include "tools/plot/pdf_image.h"
#include "tools/sweep/advice.h"
#include "tools/sweep/build.h"
#include "tools/sweep/pixel_samples.h"

#include <algorithm>
#include <cmath>
#include <random>

namespace acdf::tools {
namespace {

using measure::ShadingPoint;

builder::BrdfOptions options_of(const Step& step, const input::Brdf& brdf, const SweepOptions& sweep) {
    builder::BrdfOptions out;
    out.source.name = brdf.name;
    out.source.sha256 = brdf.sha256;
    out.channels = sweep.target.channels;
    out.goal = builder::Goal::of_budget(step.budget);
    if (step.file != "cdf" && step.file != "uniform") return out;
    out.fit = step.file == "cdf" ? ACDF_FIT_CDF : ACDF_FIT_UNIFORM;
    // Three segments in theta_h for one in phi_h, as in Lawrence et al. 2005, §6.2.
    const double bins = brdf.isotropic ? 32.0 : 32.0 * 16.0, cells = double(cells_in(step.budget)) / bins;
    out.phi_segments = static_cast<std::uint32_t>(std::max(2.0, std::round(std::sqrt(cells / 3.0))));
    out.theta_segments = static_cast<std::uint32_t>(std::max(2.0, std::round(cells / out.phi_segments)));
    return out;
}

std::vector<Step> steps_of(const SweepOptions& options) {
    const std::vector<std::uint64_t> budgets =
        options.budgets.empty() ? std::vector<std::uint64_t>{4096, 16384, 65536, 262144} : options.budgets;
    std::vector<Step> out;
    for (const std::string& file : options.files.empty() ? brdf_files() : options.files)
        for (std::uint64_t budget : budgets) out.push_back({file, budget});
    return out;
}

std::string text_of(const Step& step, const builder::BrdfOptions& o) {
    if (step.file == "variance") return "--budget " + budget_text(step.budget);
    return "--fit " + step.file + " " + knots_text(o.phi_segments, o.theta_segments);
}

const char* brdf_label(const std::string& fit) {
    return fit == "variance" ? "a tree of halvings (default)"
           : fit == "cdf"    ? "cdf fit (the paper's)"
                             : "uniform knots";
}

/// In double precision, for any view.
class RglPoint final : public measure::PointSampler {
public:
    explicit RglPoint(const measure::RglSampler& rgl) : rgl_(rgl) {}
    void move_to(const ShadingPoint& point) override { std::copy_n(point.wo, 3, wo_); }
    AcdfDirectionSample sample(double u0, double u1) const override {
        const double u[2] = {u0, u1};
        const measure::BrdfSample s = rgl_.sample(wo_, u);
        AcdfDirectionSample out{};
        for (int i = 0; i < 3; ++i) out.direction[i] = static_cast<float>(s.wi[i]);
        out.pdf = static_cast<float>(s.pdf);
        return out;
    }
    float pdf(const float wi[3]) const override {
        const double w[3] = {wi[0], wi[1], wi[2]};
        return static_cast<float>(rgl_.pdf(wo_, w));
    }

private:
    const measure::RglSampler& rgl_;
    double wo_[3] = {0.0, 0.0, 1.0};
};

void take(SweepRow& row, const builder::BrdfAccuracy& a) {
    row.cells = a.cells;
    row.relative_variance = a.support_violations > 0 ? HUGE_VAL : a.relative_variance;
    row.worst = a.support_violations > 0 ? HUGE_VAL : a.worst;
    row.median = a.median;
    row.max_weight = a.support_violations > 0 ? HUGE_VAL : a.max_weight;
    row.rms = a.rms_pdf_error;
}

Candidate make_file(const input::Brdf& brdf, const SweepOptions& sweep, const Step& step) {
    const builder::BrdfOptions options = options_of(step, brdf, sweep);
    builder::BrdfFile made;
    throw_unless_built(builder::brdf(builder::described(brdf), options, made));
    Candidate out = file_candidate(std::move(made.bytes));
    out.row.label = brdf_label(step.file);
    out.row.command = "brdf";
    out.row.options = text_of(step, options);
    take(out.row, made.accuracy);
    return out;
}

measure::ShadingPoint point_of(const compress::View& view) {
    double wo[3];
    view.direction(wo);
    return {
        {0.0f, 0.0f, 1.0f}, {static_cast<float>(wo[0]), static_cast<float>(wo[1]), static_cast<float>(wo[2])}, {}};
}

/// `points`: the views over which baselines are measured.
std::vector<Candidate> baselines(const input::Brdf& brdf, const compress::Reflected& reflected, std::uint32_t count,
                                 std::vector<SampledPoint>& points) {
    const std::vector<compress::View> views = build::random_views(count, brdf.isotropic);
    std::vector<Candidate> out;
    const auto add = [&](const char* system, const std::string& label,
                         std::shared_ptr<const measure::LightSampler> sampler, const build::ViewPdf& pdf) {
        out.push_back(baseline_candidate(system, label, std::move(sampler)));
        // The same sums as of files.
        auto measured = build::measure_views(pdf, reflected, views);
        if (points.empty())
            for (const build::ViewAccuracy& each : measured) points.push_back({point_of(each.view), each.albedo});
        measured = build::with_lost_samples(std::move(measured)); // below the surface
        take(out.back().row, build::summary(measured));
        out.back().row.cells = 0;
    };
    const auto add_table = [&](const char* system, const char* label, measure::BrdfTableKind kind) {
        const auto table = std::make_shared<const measure::TabulatedBrdf>(reflected, brdf.isotropic, kind);
        add(system, label, measure::tabulated_brdf_sampler(*table),
            [&](const double wo[3], const double wi[3]) { return table->pdf(wo, wi); });
        out.back().tables = table;
    };
    add_table("full_table", "full table 32 x 16 x 256 x 32", measure::BrdfTableKind::mean);
    add_table("full_table_centre", "the same table as published, for its bins' centres",
              measure::BrdfTableKind::centre);
    const measure::GgxSampler ggx(measure::best_ggx(reflected, views).alpha);
    add("ggx", "best GGX lobe, alpha " + short_number(ggx.alpha()), measure::ggx_sampler(ggx.alpha()),
        [&](const double wo[3], const double wi[3]) { return ggx.pdf(wo, wi); });
    add("cosine", "cosine hemisphere", measure::cosine_sampler(), measure::CosineSampler::pdf);
    if (const auto* rgl = dynamic_cast<const input::RglBrdf*>(&brdf)) {
        const measure::RglSampler sampler(*rgl);
        add("rgl", "the RGL database's own sampler",
            std::make_shared<measure::MovedToPoints<measure::RglSampler, RglPoint>>(*rgl),
            [&](const double wo[3], const double wi[3]) { return sampler.pdf(wo, wi); });
    }
    return out;
}

void add_pictures(Sweep& sweep, const compress::Reflected& reflected, const std::vector<Candidate>& candidates) {
    const ViewAngles angles{45.0, 0.0};
    const build::Map map = plot_map(build::Layout::latlong, kPictureWidth);
    float view[3];
    PlottedView{candidates.front().file->file.brdf(), angles}.direction(view);
    const double wo[3] = {view[0], view[1], view[2]};
    const double x = std::sqrt(1.0 - wo[2]);
    const build::ViewPdf uniform = [](const double*, const double*) { return 0.5 / ACDF_PI; };
    const double albedo = build::measure_views(uniform, reflected, {{x, 0.0}}).front().albedo;
    const PdfFunction own = [&](const float wi[3]) {
        const double w[3] = {wi[0], wi[1], wi[2]};
        return w[2] > 0.0 && albedo > 0.0 ? static_cast<float>(reflected(wo, w) / albedo) : 0.0f;
    };
    const PdfImage full = pdf_image(map, own);
    sweep.range = automatic_range(full);
    add_colour_bar(sweep);
    add_picture(
        sweep, full, {}, {}, "The BRDF itself times cosine, seen from 45 degrees",
        "The directions of light that are reflected to a view at 45 degrees, in false colour; the lower half "
        "is below the surface.");
    for (std::size_t i : largest_of_each_kind(candidates)) {
        const PlottedView plotted{candidates[i].file->file.brdf(), angles};
        add_picture(
            sweep, pdf_image(map, pdf_of(plotted)), knot_opacity(plotted, map), {},
            picture_title(candidates[i].row),
            "The pdf that this file has for the same view, in the same colours, with the borders of its cells.");
    }
}

/// Files and baselines with a renderer's points.
void add_sobol(const compress::Reflected& reflected, const std::vector<SampledPoint>& points,
               const SweepOptions& options, std::vector<Candidate>& candidates) {
    const SampledIntegrand integrand = [&](std::size_t i, const float wi[3]) {
        const float* o = points[i].shading.wo;
        const double wo[3] = {o[0], o[1], o[2]}, light[3] = {wi[0], wi[1], wi[2]};
        return light[2] > 0.0 ? reflected(wo, light) : 0.0;
    };
    for (Candidate& each : candidates)
        if (std::isfinite(each.row.relative_variance))
            each.row.sobol = sobol_variance(*each.sampler, points, integrand, options.visible.spp, options.seeds);
}

} // namespace

const std::vector<std::string>& brdf_files() {
    static const std::vector<std::string> names{"variance", "cdf", "uniform"};
    return names;
}

Sweep sweep_brdf(const input::Brdf& brdf, const SweepOptions& options, const build::Progress& progress) {
    Sweep sweep;
    sweep.kind = SweepKind::brdf;
    take_options(sweep, options);
    const auto part = [&](double begin, double width) { return part_of(progress, begin, width); };
    const builder::Channels& channels = options.target.channels;
    const compress::Reflected reflected =
        build::reflected_light(brdf, channels.mode, {channels.weights.r, channels.weights.g, channels.weights.b});
    sweep.conditions = build::kMeasuredViews;
    std::vector<Candidate> candidates;
    build_all(
        sweep, candidates, steps_of(options), [&](const Step& step) { return make_file(brdf, options, step); },
        part(0.0, 0.7));
    part(0.7, 0.0)(0.0, "measuring baselines");
    sweep.reference = candidates.size();
    std::vector<SampledPoint> sampled;
    for (Candidate& baseline : baselines(brdf, reflected, options.views, sampled))
        candidates.push_back(std::move(baseline));
    part(0.8, 0.0)(0.0, "plotting");
    add_sobol(reflected, sampled, options, candidates);
    if (options.pictures) add_pictures(sweep, reflected, candidates);
    std::vector<ShadingPoint> points;
    for (const compress::View& view : build::random_views(4096, false)) points.push_back(point_of(view));
    std::shuffle(points.begin(), points.end(), std::mt19937_64(1)); // views are ordered, and blocks see a few
    finish_rows(sweep, std::move(candidates), points, options, part(0.9, 0.1));
    return sweep;
}

} // namespace acdf::tools
