#include "tools/sweep/text.h"

#include "tools/cli/json.h"
#include "tools/cli/noise.h"
#include "tools/sweep/advice.h"
#include "tools/sweep/cost.h"
#include "tools/sweep/renderers.h"

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <optional>

namespace acdf::tools {
namespace {

double rounded(double value) {
    char text[32];
    std::snprintf(text, sizeof text, "%.9g", value);
    return std::strtod(text, nullptr);
}

const SweepTimes& reference(const Sweep& sweep) { return sweep.rows[sweep.reference].times; }

Interval sample_ratio(const Sweep& sweep, const SweepRow& row) {
    return ratio_interval(row.times.sample, reference(sweep).sample);
}

using S = const Sweep&;
using R = const SweepRow&;

template <Estimator E, Case C>
SweepValue exact_of(S, R r) {
    return r.noise[E][C].exact;
}
template <Estimator E, Case C>
SweepValue sobol_of(S, R r) {
    return r.noise[E][C].sobol;
}
template <Estimator E>
SweepValue mean_of(S s, R r) {
    return s.kind == SweepKind::probe ? case_mean(s, r, E) : kUnknown;
}

template <Estimator E>
double time_ratio(S s, R r) {
    return cost_ratio(r, s.rows[s.reference], E, s.costs).value;
}
template <Estimator E>
SweepValue equal_time_of(S s, R r) {
    return s.kind == SweepKind::probe ? case_mean(s, r, E) * time_ratio<E>(s, r) : kUnknown;
}

constexpr SweepColumn columns[] = {
    {"system", nullptr, false, [](S, R r) -> SweepValue { return r.system; }},
    {"file", nullptr, false, [](S, R r) -> SweepValue { return r.file; }},
    {"label", "what", false, [](S, R r) -> SweepValue { return r.label; }},
    {"options", "options", false, [](S, R r) -> SweepValue { return r.options; }},
    {"bytes", "memory", false, [](S, R r) -> SweepValue { return r.bytes; }},
    {"file_bytes", "file", false,
     [](S, R r) -> SweepValue { return r.ours() ? SweepValue(r.file_bytes) : SweepValue(kUnknown); }},
    {"cells", nullptr, false,
     [](S, R r) -> SweepValue { return r.cells > 0 ? SweepValue(r.cells) : SweepValue(kUnknown); }},
    {"alone", "light samples alone", false, mean_of<light_alone>},
    {"mis", "with MIS", false, mean_of<with_mis>},
    {"alone_diffuse_open", nullptr, false, exact_of<light_alone, diffuse_open>},
    {"alone_diffuse_hidden", nullptr, false, exact_of<light_alone, diffuse_hidden>},
    {"alone_glossy_open", nullptr, false, exact_of<light_alone, glossy_open>},
    {"alone_glossy_hidden", nullptr, false, exact_of<light_alone, glossy_hidden>},
    {"mis_diffuse_open", nullptr, false, exact_of<with_mis, diffuse_open>},
    {"mis_diffuse_hidden", nullptr, false, exact_of<with_mis, diffuse_hidden>},
    {"mis_glossy_open", nullptr, false, exact_of<with_mis, glossy_open>},
    {"mis_glossy_hidden", nullptr, false, exact_of<with_mis, glossy_hidden>},
    {"sobol_alone_diffuse_open", nullptr, false, sobol_of<light_alone, diffuse_open>},
    {"sobol_alone_diffuse_hidden", nullptr, false, sobol_of<light_alone, diffuse_hidden>},
    {"sobol_alone_glossy_open", nullptr, false, sobol_of<light_alone, glossy_open>},
    {"sobol_alone_glossy_hidden", nullptr, false, sobol_of<light_alone, glossy_hidden>},
    {"sobol_mis_diffuse_open", nullptr, false, sobol_of<with_mis, diffuse_open>},
    {"sobol_mis_diffuse_hidden", nullptr, false, sobol_of<with_mis, diffuse_hidden>},
    {"sobol_mis_glossy_open", nullptr, false, sobol_of<with_mis, glossy_open>},
    {"sobol_mis_glossy_hidden", nullptr, false, sobol_of<with_mis, glossy_hidden>},
    {"relative_variance", "relative variance", false, [](S, R r) -> SweepValue { return r.relative_variance; }},
    {"noise", nullptr, false,
     [](S s, R r) -> SweepValue {
         return s.kind == SweepKind::brdf ? std::sqrt(r.relative_variance / s.visible.spp) : kUnknown;
     }},
    {"worst", "worst", false, [](S, R r) -> SweepValue { return r.worst; }},
    {"median", "median", false, [](S, R r) -> SweepValue { return r.median; }},
    {"sobol", "with Sobol' points", false, [](S, R r) -> SweepValue { return r.sobol; }},
    {"max_weight", "largest weight", false, [](S, R r) -> SweepValue { return r.max_weight; }},
    {"rms_pdf_error", "RMS error of pdf", false, [](S, R r) -> SweepValue { return r.rms; }},
    {"build_seconds", "build, s", true, [](S, R r) -> SweepValue { return r.build_seconds; }},
    {"ns_per_sample", "ns a sample", true,
     [](S, R r) -> SweepValue { return median_interval(r.times.sample).value; }},
    {"ns_per_sample_low", nullptr, true, [](S, R r) -> SweepValue { return median_interval(r.times.sample).low; }},
    {"ns_per_sample_high", nullptr, true,
     [](S, R r) -> SweepValue { return median_interval(r.times.sample).high; }},
    {"ns_per_pdf", "ns a pdf", true, [](S, R r) -> SweepValue { return median_interval(r.times.pdf).value; }},
    {"ns_per_pdf_low", nullptr, true, [](S, R r) -> SweepValue { return median_interval(r.times.pdf).low; }},
    {"ns_per_pdf_high", nullptr, true, [](S, R r) -> SweepValue { return median_interval(r.times.pdf).high; }},
    {"time_ratio", "time ratio", true, [](S s, R r) -> SweepValue { return sample_ratio(s, r).value; }},
    {"time_ratio_low", nullptr, true, [](S s, R r) -> SweepValue { return sample_ratio(s, r).low; }},
    {"time_ratio_high", nullptr, true, [](S s, R r) -> SweepValue { return sample_ratio(s, r).high; }},
    {"equal_time_alone", nullptr, true, equal_time_of<light_alone>},
    {"equal_time_mis", nullptr, true, equal_time_of<with_mis>},
    {"equal_time_variance", nullptr, true,
     [](S s, R r) -> SweepValue {
         return s.kind == SweepKind::brdf ? r.relative_variance * time_ratio<light_alone>(s, r) : kUnknown;
     }},
};

std::string csv_text(const std::string& text) {
    if (text.find_first_of(",\"\r\n") == std::string::npos) return text;
    std::string out = "\"";
    for (char c : text) out += c == '"' ? std::string("\"\"") : std::string(1, c);
    return out + "\"";
}

nlohmann::ordered_json json_value(const SweepValue& value) {
    if (const auto* text = std::get_if<std::string>(&value)) return *text;
    if (const auto* count = std::get_if<std::uint64_t>(&value)) return *count;
    const double number = std::get<double>(value);
    return std::isfinite(number) ? nlohmann::ordered_json(rounded(number)) : nlohmann::ordered_json(nullptr);
}

nlohmann::ordered_json interval_json(const Interval& i) {
    if (!i.known()) return nullptr;
    return {rounded(i.value), rounded(i.low), rounded(i.high)};
}

nlohmann::ordered_json comparison_json(const BaselineComparison& c, bool timed) {
    constexpr const char* verdicts[] = {"acdf", "baseline", "even", "unknown"};
    nlohmann::ordered_json out = {
        {"row", c.row}, {"bytes_ratio", json_value(c.bytes)}, {"variance_ratio", json_value(c.variance)}};
    if (!timed) return out;
    out["time_ratio"] = interval_json(c.time);
    out["equal_time_variance_ratio"] = interval_json(c.equal_time);
    out["better_at_equal_time"] = verdicts[static_cast<int>(c.verdict)];
    return out;
}

nlohmann::ordered_json rival_json(const std::optional<Rival>& rival) {
    if (!rival) return nullptr;
    return {{"row", rival->row}, {"variance_ratio", interval_json(rival->variance)}};
}

nlohmann::ordered_json renderer_json(const RendererAdvice& advice) {
    return {{"renderer", to_string(advice.renderer)},
            {"row", advice.row},
            {"relative_variance", json_value(advice.variance)},
            {"noise_percent", noise_json(advice.variance)},
            {"reference_variance_ratio", interval_json(advice.over_reference)},
            {"other_kind", rival_json(advice.other)},
            {"baseline", rival_json(advice.baseline)},
            {"sentence", advice.sentence},
            {"command", advice.command}};
}

} // namespace

std::string exact_text(const SweepValue& value) {
    if (const auto* text = std::get_if<std::string>(&value)) return *text;
    if (const auto* count = std::get_if<std::uint64_t>(&value)) return std::to_string(*count);
    const double number = std::get<double>(value);
    if (std::isinf(number)) return "inf";
    if (!(number == number)) return "";
    char text[32];
    std::snprintf(text, sizeof text, "%.9g", number);
    return text;
}

std::vector<SweepColumn> columns_of(const Sweep& sweep) {
    std::vector<SweepColumn> out;
    for (const SweepColumn& column : columns)
        if (sweep.timed || !column.timing) out.push_back(column);
    return out;
}

std::string sweep_csv(const Sweep& sweep) {
    std::string out;
    const std::vector<SweepColumn> all = columns_of(sweep);
    for (const SweepColumn& column : all) out += (out.empty() ? "" : ",") + std::string(column.name);
    for (const SweepRow& row : sweep.rows) {
        out += "\n";
        for (std::size_t i = 0; i < all.size(); ++i)
            out += (i > 0 ? "," : "") + csv_text(exact_text(all[i].value(sweep, row)));
    }
    return out + "\n";
}

std::string sweep_json(const Sweep& sweep) {
    const Advice advice = advise(sweep);
    nlohmann::ordered_json out = {{"kind", to_string(sweep.kind)},
                                  {"source", sweep.source},
                                  {"description", sweep.description},
                                  {"conditions", sweep.conditions},
                                  {"timed", sweep.timed},
                                  {"reference", sweep.reference},
                                  {"spp", sweep.visible.spp},
                                  {"threshold", sweep.visible.threshold},
                                  {"sequence", sweep.numbers == measure::Numbers::sobol ? "sobol" : "independent"},
                                  {"heuristic", sweep.heuristic == ACDF_HEURISTIC_POWER ? "power" : "balance"},
                                  {"on_mesh", sweep.on_mesh},
                                  {"shadow_ray_ns", sweep.costs.shadow_ray_ns},
                                  {"rule", advice.rule},
                                  {"renderers", nlohmann::ordered_json::array()},
                                  {"recommendation", nullptr},
                                  {"findings", advice.findings},
                                  {"notes", sweep.notes},
                                  {"comparisons", nlohmann::ordered_json::array()},
                                  {"rows", nlohmann::ordered_json::array()}};
    for (const RendererAdvice& one : advice.renderers) out["renderers"].push_back(renderer_json(one));
    if (sweep.kind == SweepKind::brdf)
        out["recommendation"] = {{"row", advice.recommended.row},
                                 {"reached", advice.recommended.reached},
                                 {"sentence", advice.sentence},
                                 {"command", advice.command}};
    for (const BaselineComparison& c : advice.comparisons)
        out["comparisons"].push_back(comparison_json(c, sweep.timed));
    for (const SweepRow& row : sweep.rows) {
        nlohmann::ordered_json each;
        for (const SweepColumn& column : columns_of(sweep))
            each[column.name] = json_value(column.value(sweep, row));
        each["needs_mis"] = row.needs_mis;
        each["biased"] = std::isinf(row.relative_variance) && !row.needs_mis;
        out["rows"].push_back(std::move(each));
    }
    return json_text(out);
}

} // namespace acdf::tools
