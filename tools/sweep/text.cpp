#include "tools/sweep/text.h"

#include "tools/cli/json.h"
#include "tools/cli/noise.h"
#include "tools/sweep/advice.h"

#include <cmath>
#include <cstdio>
#include <cstdlib>

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

constexpr SweepColumn columns[] = {
    {"system", nullptr, false, [](S, R r) -> SweepValue { return r.system; }},
    {"fit", nullptr, false, [](S, R r) -> SweepValue { return r.fit; }},
    {"label", "what", false, [](S, R r) -> SweepValue { return r.label; }},
    {"options", "options", false, [](S, R r) -> SweepValue { return r.options; }},
    {"bytes", "memory", false, [](S, R r) -> SweepValue { return r.bytes; }},
    {"file_bytes", "file", false,
     [](S, R r) -> SweepValue { return r.ours() ? SweepValue(r.file_bytes) : SweepValue(kUnknown); }},
    {"cells", "cells", false,
     [](S, R r) -> SweepValue { return r.cells > 0 ? SweepValue(r.cells) : SweepValue(kUnknown); }},
    {"relative_variance", "relative variance", false, [](S, R r) -> SweepValue { return r.relative_variance; }},
    {"noise", "noise", false, [](S s, R r) -> SweepValue { return std::sqrt(r.shaded() / s.visible.spp); }},
    {"noise_16", nullptr, false, [](S, R r) -> SweepValue { return noise_of(r.shaded(), 16); }},
    {"noise_64", nullptr, false, [](S, R r) -> SweepValue { return noise_of(r.shaded(), 64); }},
    {"noise_256", nullptr, false, [](S, R r) -> SweepValue { return noise_of(r.shaded(), 256); }},
    {"worst", "worst", false, [](S, R r) -> SweepValue { return r.worst; }},
    {"median", "median", false, [](S, R r) -> SweepValue { return r.median; }},
    {"sobol", "with Sobol' points", false, [](S, R r) -> SweepValue { return r.sobol; }},
    {"irradiance_variance", "on a diffuse surface", false,
     [](S, R r) -> SweepValue { return r.lit[open_alone].mean; }},
    {"irradiance_median", nullptr, false, [](S, R r) -> SweepValue { return r.lit[open_alone].median; }},
    {"irradiance_sobol", nullptr, false, [](S, R r) -> SweepValue { return r.lit[open_alone].sobol; }},
    {"partner_variance", "the same with an MIS partner", false,
     [](S, R r) -> SweepValue { return r.lit[open_partner].mean; }},
    {"partner_median", nullptr, false, [](S, R r) -> SweepValue { return r.lit[open_partner].median; }},
    {"partner_sobol", nullptr, false, [](S, R r) -> SweepValue { return r.lit[open_partner].sobol; }},
    {"hidden_variance", "behind occluders", false, [](S, R r) -> SweepValue { return r.lit[hidden_alone].mean; }},
    {"hidden_median", nullptr, false, [](S, R r) -> SweepValue { return r.lit[hidden_alone].median; }},
    {"hidden_sobol", nullptr, false, [](S, R r) -> SweepValue { return r.lit[hidden_alone].sobol; }},
    {"hidden_partner_variance", "behind occluders, with an MIS partner", false,
     [](S, R r) -> SweepValue { return r.lit[hidden_partner].mean; }},
    {"hidden_partner_median", nullptr, false, [](S, R r) -> SweepValue { return r.lit[hidden_partner].median; }},
    {"hidden_partner_sobol", nullptr, false, [](S, R r) -> SweepValue { return r.lit[hidden_partner].sobol; }},
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
    {"equal_time_variance", "variance at equal time", true,
     [](S s, R r) -> SweepValue {
         return r.shaded() * cost_ratio(r, s.rows[s.reference], open_alone, s.costs).value;
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

nlohmann::ordered_json situation_json(const SituationAdvice& s) {
    return {{"situation", to_string(s.situation)},
            {"relative_variance", json_value(s.lit.mean)},
            {"median", json_value(s.lit.median)},
            {"sobol", json_value(s.lit.sobol)},
            {"noise_percent", noise_json(s.lit.mean)},
            {"reference_variance_ratio", interval_json(s.over_reference)},
            {"best_baseline", s.has_baseline ? nlohmann::ordered_json(s.best_baseline) : nlohmann::ordered_json()},
            {"best_baseline_variance_ratio", interval_json(s.over_best_baseline)}};
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
    nlohmann::ordered_json out = {
        {"kind", to_string(sweep.kind)},
        {"source", sweep.source},
        {"description", sweep.description},
        {"conditions", sweep.conditions},
        {"timed", sweep.timed},
        {"reference", sweep.reference},
        {"recommendation",
         {{"row", advice.recommended.row},
          {"reached", advice.recommended.reached},
          {"spp", sweep.visible.spp},
          {"threshold", sweep.visible.threshold},
          {"sentence", advice.sentence},
          {"sequence", sweep.numbers == measure::Numbers::sobol ? "sobol" : "independent"},
          {"shadow_ray_ns", sweep.costs.shadow_ray_ns},
          {"rule", advice.rule},
          {"command", advice.command}}},
        {"findings", advice.findings},
        {"notes", sweep.notes},
        {"pictures", nlohmann::ordered_json::array()},
        {"comparisons", nlohmann::ordered_json::array()},
        {"rows", nlohmann::ordered_json::array()}};
    for (const SituationAdvice& one : advice.situations) out["pictures"].push_back(situation_json(one));
    for (const BaselineComparison& c : advice.comparisons)
        out["comparisons"].push_back(comparison_json(c, sweep.timed));
    for (const SweepRow& row : sweep.rows) {
        nlohmann::ordered_json each;
        for (const SweepColumn& column : columns_of(sweep))
            each[column.name] = json_value(column.value(sweep, row));
        each["biased"] = std::isinf(row.relative_variance);
        out["rows"].push_back(std::move(each));
    }
    return json_text(out);
}

} // namespace acdf::tools
