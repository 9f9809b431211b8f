#include "tools/render/report.h"

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

ordered_json sampler_json(const Compared& one, bool timed) {
    ordered_json out{{"sampler", one.spec.text},
                     {"ours", one.ours},
                     {"bytes", one.bytes},
                     {"build_seconds", one.build_seconds},
                     {"relative_variance", interval_json(one.relative_variance)},
                     {"relative_variance_median", one.median},
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
    out["nanoseconds"] = interval_json(measure::mean_interval(one.nanoseconds));
    out["equal_time_gain"] = interval_json(one.equal_time);
    return out;
}

ordered_json comparison_json(const Comparison& comparison, bool timed) {
    ordered_json out{{"sky_hidden", comparison.sky_hidden}, {"samplers", ordered_json::array()}};
    for (const Compared& one : comparison.samplers) out["samplers"].push_back(sampler_json(one, timed));
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

std::string table(const Comparison& comparison, bool timed) {
    const int width = static_cast<int>(std::min<std::size_t>(name_width(comparison), 60));
    std::string out = format("%-*s %10s %6s %6s %22s %22s", width, "sampler", "memory", "above", "rays",
                             "relative variance", "gain, equal samples");
    if (timed) out += format(" %10s %22s", "us", "gain, equal time");
    out += format(" %8s\n", "bias/se");
    for (const Compared& one : comparison.samplers) {
        const measure::Interval& v = one.relative_variance;
        out +=
            format("%-*s %10s %5.1f%% %6.1f %22s %22s", width, one.spec.text.c_str(),
                   to_readable_size(one.bytes).c_str(), 100.0 * one.share_above, one.shadow_rays,
                   format("%.4g +- %.2g", v.value, v.high - v.value).c_str(), gain_text(one.equal_samples).c_str());
        if (timed)
            out += format(" %10.3g %22s", 1e-3 * measure::mean_interval(one.nanoseconds).value,
                          gain_text(one.equal_time).c_str());
        out += format(" %+8.1f\n", one.bias_standard_errors);
    }
    for (const std::string& sentence : verdict(comparison, timed)) out += sentence + "\n";
    return out;
}

std::vector<std::string> ranking(const Comparison& comparison) {
    std::vector<const Compared*> sorted;
    for (const Compared& one : comparison.samplers) sorted.push_back(&one);
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

std::string change_text(const RenderRun& run, Gain gain, const char* equal) {
    std::vector<std::string> pairs;
    for (const Overtaking& pair : overtakings(run.comparison, *run.in_the_open, gain))
        pairs.push_back("'" + pair.winner->spec.text + "' overtakes '" + pair.loser->spec.text + "'");
    const std::string where = std::string("At equal ") + equal + " what hides light changes ";
    if (pairs.empty()) return where + "no order beyond the noise of this run.";
    return where + "the ranking: " + joined(pairs) + ".";
}

/// Pairs [winner, loser] where light is hidden.
ordered_json overtakings_json(const RenderRun& run, Gain gain) {
    ordered_json out = ordered_json::array();
    for (const Overtaking& pair : overtakings(run.comparison, *run.in_the_open, gain))
        out.push_back({pair.winner->spec.text, pair.loser->spec.text});
    return out;
}

} // namespace

ordered_json render_json(const LoadedScene& scene, const RenderRun& run) {
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
    out.update(comparison_json(run.comparison, o.timing));
    out["ranking"] = ranking(run.comparison);
    if (run.in_the_open) {
        out["nothing_hidden"] = comparison_json(*run.in_the_open, o.timing);
        out["nothing_hidden"]["ranking"] = ranking(*run.in_the_open);
        out["overtakings_equal_samples"] = overtakings_json(run, gain_at_equal_samples);
        if (o.timing) out["overtakings_equal_time"] = overtakings_json(run, gain_at_equal_time);
    }
    return out;
}

std::string render_table(const LoadedScene& scene, const RenderRun& run) {
    const ComparisonOptions& o = run.options;
    std::string out =
        format("%s: %zu points in %ux%u pixels, %u samples, %u seeds, light %s %dx%d\n", run.scene.c_str(),
               scene.points.points.size(), scene.scene.width, scene.scene.height, o.samples, o.render.seeds,
               scene.probe.source_name.c_str(), scene.probe.width, scene.probe.height);
    out += format("%.1f %% of the sky is hidden (cosine-weighted mean)\n", 100.0 * run.comparison.sky_hidden);
    out += table(run.comparison, o.timing);
    if (!run.in_the_open) return out;
    out += "\nThe same with nothing in the way of light:\n" + table(*run.in_the_open, o.timing);
    const auto hidden = ranking(run.comparison), open = ranking(*run.in_the_open);
    out += "\nRanking by variance, with what hides light: " + joined(hidden) + "\n";
    out += "and with nothing in the way:                " + joined(open) + "\n";
    out += change_text(run, gain_at_equal_samples, "samples") + "\n";
    if (o.timing) out += change_text(run, gain_at_equal_time, "time") + "\n";
    return out;
}

} // namespace acdf::tools
