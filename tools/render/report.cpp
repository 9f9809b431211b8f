#include "tools/render/report.h"

#include "tools/cli/json.h"
#include "tools/cli/noise.h"
#include "tools/cli/sizes.h"

#include <algorithm>
#include <cmath>
#include <cstdarg>
#include <cstdio>

namespace acdf::tools {
namespace {

using nlohmann::ordered_json;

ordered_json interval_json(const measure::Interval& interval) { // JSON has no infinity: null
    return {{"value", interval.value}, {"low", interval.low}, {"high", interval.high}};
}

/// Of a picture of so many samples, per cent; where numbers are not independent only with those that were sampled.
ordered_json noise(const Compared& one, std::uint32_t samples) {
    if (one.scales) return noise_json(one.relative_variance.value * samples);
    return {{std::to_string(samples), 100.0 * std::sqrt(one.relative_variance.value)}};
}

std::string noise_column(const Compared& one, std::uint32_t samples) {
    const double variance = one.relative_variance.value * samples; // of one sample
    if (!one.resolved()) return "unsure";
    return one.scales ? noise_texts(variance) : noise_text(variance, samples);
}

ordered_json sampler_json(const Compared& one, std::uint32_t samples, bool timed) {
    ordered_json out{{"sampler", one.spec.text},
                     {"ours", one.ours},
                     {"bytes", one.bytes},
                     {"build_seconds", one.build_seconds},
                     {"relative_variance", interval_json(one.relative_variance)},
                     {"relative_variance_median", one.median},
                     {"resolved", one.resolved()},
                     {"noise_percent", noise(one, samples)},
                     {"equal_samples_gain", interval_json(one.equal_samples)},
                     {"share_above_horizon", one.share_above},
                     {"least_share_above_horizon", one.least_share_above},
                     {"shadow_rays", one.shadow_rays},
                     {"bias", one.bias},
                     {"bias_standard_errors", one.bias_standard_errors}};
    if (!timed) {
        out.erase("build_seconds");
        return out;
    }
    if (one.making.seconds > 0.0) { // of a picture
        out["making_seconds"] = one.making.seconds;
        out["making_shadow_rays"] = one.making.shadow_rays;
    }
    out["nanoseconds"] = interval_json(measure::mean_interval(one.nanoseconds));
    out["equal_time_gain"] = interval_json(one.equal_time);
    return out;
}

ordered_json comparison_json(const Comparison& comparison, const ComparisonOptions& o) {
    const bool timed = o.timing;
    ordered_json out{{"sky_hidden", comparison.sky_hidden}, {"samplers", ordered_json::array()}};
    for (const Compared& one : comparison.samplers) out["samplers"].push_back(sampler_json(one, o.samples, timed));
    out["verdict"] = verdict(comparison, timed);
    return out;
}

std::string format(const char* text, ...) {
    char line[512];
    va_list arguments;
    va_start(arguments, text);
    std::vsnprintf(line, sizeof line, text, arguments);
    va_end(arguments);
    return line;
}

std::string gain_text(const measure::Interval& interval) {
    return format("%.3g [%.3g, %.3g]", interval.value, interval.low, interval.high);
}

std::size_t name_width(const Comparison& comparison) {
    std::size_t width = 8;
    for (const Compared& one : comparison.samplers) width = std::max(width, one.spec.text.size());
    return width;
}

/// Of the samplers as they were measured: with independent numbers the table has the noise at other counts of
/// samples, too.
std::string table(const RenderPass& pass, const Comparison& comparison, const ComparisonOptions& o) {
    const bool timed = o.timing, scale = pass.numbers == measure::Numbers::independent;
    const int width = static_cast<int>(std::min<std::size_t>(name_width(comparison), 60));
    const std::string noise = scale ? "noise at 16, 64, 256" : "noise at " + std::to_string(o.samples);
    std::string out = format("%-*s %10s %6s %6s %22s %9s %21s %22s", width, "sampler", "memory", "above", "rays",
                             "relative variance", "median", noise.c_str(), "gain, equal samples");
    if (timed) out += format(" %10s %22s", "us", "gain, equal time");
    out += format(" %8s\n", "bias/se");
    for (const Compared& one : comparison.samplers) {
        const measure::Interval& v = one.relative_variance;
        const auto gain = [&](const measure::Interval& g) { return one.resolved() ? gain_text(g) : "unsure"; };
        out += format("%-*s %10s %5.1f%% %6.1f %22s %9.3g %21s %22s", width, one.spec.text.c_str(),
                      to_readable_size(one.bytes).c_str(), 100.0 * one.share_above, one.shadow_rays,
                      format("%.4g +- %.2g", v.value, v.high - v.value).c_str(), one.median,
                      noise_column(one, o.samples).c_str(), gain(one.equal_samples).c_str());
        if (timed)
            out += format(" %10.3g %22s", 1e-3 * measure::mean_interval(one.nanoseconds).value,
                          gain(one.equal_time).c_str());
        out += format(" %+8.1f\n", one.bias_standard_errors);
    }
    for (const Compared& one : comparison.samplers)
        if (timed && one.making.seconds > 0.0)
            out += format(
                "'%s' was made for the picture in %.3g s of processor time, with %.3g shadow rays; us and gain "
                "include it.\n",
                one.spec.text.c_str(), one.making.seconds, double(one.making.shadow_rays));
    for (const std::string& sentence : verdict(comparison, timed)) out += sentence + "\n";
    return out;
}

std::vector<std::string> ranking(const Comparison& comparison) {
    std::vector<const Compared*> sorted;
    for (const Compared& one : comparison.samplers)
        if (one.resolved()) sorted.push_back(&one);
    std::stable_sort(sorted.begin(), sorted.end(), [](const Compared* a, const Compared* b) {
        return a->relative_variance.value < b->relative_variance.value;
    });
    std::vector<std::string> out;
    for (const Compared* one : sorted) out.push_back(one->spec.text);
    return out;
}

std::string joined(const std::vector<std::string>& parts) {
    std::string out;
    for (const std::string& part : parts) out += (out.empty() ? "" : ", ") + part;
    return out;
}

std::string change_text(const RenderPass& run, Gain gain, const char* equal) {
    std::vector<std::string> pairs;
    for (const Overtaking& pair : overtakings(run.comparison, *run.in_the_open, gain))
        pairs.push_back("'" + pair.winner->spec.text + "' overtakes '" + pair.loser->spec.text + "'");
    const std::string where = std::string("At equal ") + equal + " occluders change ";
    if (pairs.empty()) return where + "no order beyond the noise of this run.";
    return where + "the ranking: " + joined(pairs) + ".";
}

/// Pairs [winner, loser] where light is hidden.
ordered_json overtakings_json(const RenderPass& run, Gain gain) {
    ordered_json out = ordered_json::array();
    for (const Overtaking& pair : overtakings(run.comparison, *run.in_the_open, gain))
        out.push_back({pair.winner->spec.text, pair.loser->spec.text});
    return out;
}

ordered_json pass_json(const RenderPass& pass, const ComparisonOptions& o) {
    ordered_json out = comparison_json(pass.comparison, o);
    out["ranking"] = ranking(pass.comparison);
    if (!pass.in_the_open) return out;
    out["nothing_hidden"] = comparison_json(*pass.in_the_open, o);
    out["nothing_hidden"]["ranking"] = ranking(*pass.in_the_open);
    out["overtakings_equal_samples"] = overtakings_json(pass, gain_at_equal_samples);
    if (o.timing) out["overtakings_equal_time"] = overtakings_json(pass, gain_at_equal_time);
    return out;
}

std::string pass_table(const RenderPass& pass, const ComparisonOptions& o) {
    std::string out = pass.numbers == measure::Numbers::sobol ? "With a scrambled Sobol' sequence:\n"
                                                              : "With independent random numbers:\n";
    out += table(pass, pass.comparison, o);
    if (!pass.in_the_open) return out;
    out += "\nThe same without occluders:\n" + table(pass, *pass.in_the_open, o);
    const auto hidden = ranking(pass.comparison), open = ranking(*pass.in_the_open);
    out += "\nRanking by variance, with occluders: " + joined(hidden) + "\n";
    out += "Ranking by variance, without them:   " + joined(open) + "\n";
    out += change_text(pass, gain_at_equal_samples, "samples") + "\n";
    if (o.timing) out += change_text(pass, gain_at_equal_time, "time") + "\n";
    return out;
}

} // namespace

const char* to_string(measure::Numbers numbers) {
    return numbers == measure::Numbers::sobol ? "sobol" : "independent";
}

std::string render_json(const LoadedScene& scene, const RenderRun& run) {
    const ComparisonOptions& o = run.options;
    ordered_json out{{"scene", run.scene},
                     {"description", scene.file.description},
                     {"light", scene.probe.source_name},
                     {"light_size", {scene.probe.width, scene.probe.height}},
                     {"width", scene.scene.width},
                     {"height", scene.scene.height},
                     {"points", scene.points.points.size()},
                     {"samples", o.samples},
                     {"seeds", o.render.seeds},
                     {"seed", o.render.seed},
                     {"reference", o.reference ? "sum over texels" : "mean of all samplers"}};
    if (o.timing) out["shadow_ray_ns"] = o.shadow_ray_ns;
    out["sequence"] = to_string(run.passes.front().numbers);
    out.update(pass_json(run.passes.front(), o));
    for (std::size_t i = 1; i < run.passes.size(); ++i)
        out[to_string(run.passes[i].numbers)] = pass_json(run.passes[i], o);
    return json_text(out);
}

std::string render_table(const LoadedScene& scene, const RenderRun& run) {
    const ComparisonOptions& o = run.options;
    std::string out =
        format("%s: %zu points in %ux%u pixels, %u samples, %u seeds, light %s %dx%d\n", run.scene.c_str(),
               scene.points.points.size(), scene.scene.width, scene.scene.height, o.samples, o.render.seeds,
               scene.probe.source_name.c_str(), scene.probe.width, scene.probe.height);
    out += format("%.1f %% of the sky is hidden (cosine-weighted mean)\n",
                  100.0 * run.passes.front().comparison.sky_hidden);
    for (const RenderPass& pass : run.passes) out += "\n" + pass_table(pass, o);
    return out;
}

} // namespace acdf::tools
