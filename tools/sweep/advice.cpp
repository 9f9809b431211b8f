#include "tools/sweep/advice.h"

#include "tools/cli/noise.h"
#include "tools/cli/sizes.h"
#include "tools/commands.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstring>

namespace acdf::tools {
namespace {

std::string capital(std::string text) {
    if (!text.empty() && text[0] >= 'a' && text[0] <= 'z') text[0] = static_cast<char>(text[0] - 'a' + 'A');
    return text;
}

/// "1.4 (1.3 to 1.5)".
std::string interval_text(const Interval& i) {
    return short_number(i.value) + " (" + short_number(i.low) + " to " + short_number(i.high) + ")";
}

std::string spp_text(const VisibleNoise& v) {
    return std::to_string(v.spp) + (v.spp == 1 ? " sample per pixel" : " samples per pixel");
}

std::string percent(double share) { return short_number(100.0 * share) + " %"; }

/// Beyond the recommended file: whether more was tried.
bool tried_larger(const Sweep& sweep, const SweepRow& best) {
    return std::any_of(sweep.rows.begin(), sweep.rows.end(),
                       [&](const SweepRow& row) { return row.ours() && row.bytes > best.bytes; });
}

std::string sentence_of(const Sweep& sweep, const Recommended& recommended) {
    const SweepRow& best = sweep.rows[recommended.row];
    const VisibleNoise& v = sweep.visible;
    const std::string size = size_text(best);
    const double variance = variance_in(best, open_alone, sweep.numbers);
    std::string has = "a relative variance of " + short_number(variance) + ", " + noise_text(variance, v.spp) +
                      " noise at " + spp_text(v);
    if (sweep.numbers == measure::Numbers::sobol) has += " from a scrambled Sobol' sequence";
    if (!recommended.reached)
        return "No size tried gets below " + percent(v.threshold) + " noise at " + spp_text(v) + ": the best, " +
               size + ", has " + has + ". Larger --budgets or more samples per pixel would.";
    if (!tried_larger(sweep, best)) return size + " is enough: it reaches " + has + ".";
    return size + " reaches " + has + "; beyond it you gain nothing visible.";
}

/// Of files that know no surface: what pictures have of them.
std::string picture_sentence(const Sweep& sweep, const Recommended& recommended) {
    const SweepRow &best = sweep.rows[recommended.row], &full = sweep.rows[sweep.reference];
    const VisibleNoise& v = sweep.visible;
    const auto noise = [&](const SweepRow& row) {
        return noise_text(variance_in(row, open_alone, sweep.numbers), v.spp);
    };
    std::string text = size_text(best) + " is enough: a diffuse surface has " + noise(best) + " noise with it at " +
                       spp_text(v) + ", and " + noise(full) + " with the " + full.label;
    if (recommended.reached) return text + ", which cannot be seen.";
    return text + "; no other size or fit tried lowers it by more than 5 %.";
}

std::string picture_rule(const Sweep& sweep) {
    const VisibleNoise& v = sweep.visible;
    std::string text =
        "Rule: among the files whose noise on a diffuse surface is low enough, the one that takes least memory, or "
        "one of up to a quarter more with less noise. Low enough is at most 5 % above the least noise of all "
        "files, or at most " +
        percent(v.threshold) + " at " + spp_text(v) +
        ", in each of four situations: with nothing hidden, and behind the sphere and the wall of the demo scene; "
        "each with samples of the light alone, and with half of the samples from the cosine. ";
    text += sweep.timed ? "Noise is compared after the same time. Besides sampling, each sample costs " +
                              short_number(sweep.costs.shadow_ray_ns) + " ns (--shadow-ray-ns)."
                        : "Noise is compared after the same number of samples, as nothing was timed.";
    if (sweep.numbers == measure::Numbers::sobol) text += " Samples come from a scrambled Sobol' sequence.";
    return text;
}

std::string rule_of(const Sweep& sweep) {
    const VisibleNoise& v = sweep.visible;
    std::string text = "Rule: the file tried that takes least memory and whose noise, the standard deviation "
                       "sqrt(relative variance / " +
                       std::to_string(v.spp) + ") of a pixel, is at most " + percent(v.threshold) + " of its value";
    if (v.threshold == 0.01) text += ": about half a step of 8-bit sRGB at middle grey";
    text += ". That is a relative variance of at most " + short_number(v.largest_variance()) + ".";
    if (sweep.numbers == measure::Numbers::sobol)
        text += " Samples come from a scrambled Sobol' sequence: the relative variance is then the variance times "
                "the number of samples.";
    return text;
}

BaselineComparison compare(const Sweep& sweep, std::size_t index, const SweepRow& best) {
    const SweepRow& baseline = sweep.rows[index];
    BaselineComparison out;
    out.row = index;
    out.bytes = static_cast<double>(baseline.bytes) / static_cast<double>(best.bytes);
    out.variance = baseline.shaded() / best.shaded();
    out.time = ratio_interval(baseline.times.sample, best.times.sample);
    if (std::isinf(baseline.shaded())) {
        out.verdict = Verdict::ours; // biased, however fast
        return out;
    }
    const Interval cost = cost_ratio(baseline, best, open_alone, sweep.costs);
    if (!cost.known() || !(best.shaded() > 0.0)) return out;
    out.equal_time = {cost.value * out.variance, cost.low * out.variance, cost.high * out.variance};
    out.verdict = out.equal_time.low > 1.0    ? Verdict::ours
                  : out.equal_time.high < 1.0 ? Verdict::baseline
                                              : Verdict::even;
    return out;
}

/// Those with a verdict, each with its variance at equal time: "alias table 1.3 (1.2 to 1.4); ...".
std::string named(const Sweep& sweep, const Advice& advice, Verdict verdict) {
    std::string names;
    for (const BaselineComparison& c : advice.comparisons) {
        if (c.verdict != verdict || !c.equal_time.known()) continue;
        names += (names.empty() ? "" : "; ") + sweep.rows[c.row].label + " " + interval_text(c.equal_time);
        if (verdict == Verdict::baseline && c.bytes > 1.0)
            names += " with " + short_number(c.bytes) + " times the memory";
    }
    return names;
}

/// Who wins at equal time; a sentence for each way it can end.
void add_time_findings(const Sweep& sweep, Advice& advice, const SweepRow& best) {
    const std::string than = " Figures are the variance of the baseline divided by that of the " +
                             to_readable_size(best.file_bytes > 0 ? best.file_bytes : best.bytes) +
                             " file after the same time. Besides sampling, each sample costs " +
                             short_number(sweep.costs.shadow_ray_ns) + " ns.";
    const std::string baselines = named(sweep, advice, Verdict::baseline),
                      even = named(sweep, advice, Verdict::even), ours = named(sweep, advice, Verdict::ours);
    if (!baselines.empty()) advice.findings.push_back("At equal time a baseline wins: " + baselines + "." + than);
    else if (!even.empty() || !ours.empty()) advice.findings.push_back("At equal time no baseline wins." + than);
    if (!even.empty()) advice.findings.push_back("Too close to call at equal time: " + even + ".");
    if (!ours.empty()) advice.findings.push_back("At equal time the file wins against: " + ours + ".");
    for (const BaselineComparison& c : advice.comparisons)
        if (std::isinf(sweep.rows[c.row].shaded()))
            advice.findings.push_back(capital(sweep.rows[c.row].label) +
                                      " is biased if used alone: its pdf is 0 in directions with light.");
}

/// Who wins sample for sample, whatever the time.
std::string sample_finding(const Sweep& sweep, const SweepRow& best) {
    // The light's own sum is what no picture shows; who misses a file in it finds it here.
    const std::string of =
        sweep.kind == SweepKind::environment ? "than this file on the light itself" : "than this file";
    std::string names;
    for (const SweepRow& baseline : sweep.rows)
        if (!baseline.ours() && baseline.relative_variance < best.relative_variance)
            names += (names.empty() ? "" : "; ") + baseline.label + " (" +
                     short_number(baseline.relative_variance) + ", " + to_readable_size(baseline.bytes) + ")";
    if (names.empty())
        return "At equal samples no baseline is less noisy " + of + " (relative variance " +
               short_number(best.relative_variance) + ").";
    return "At equal samples these are less noisy " + of + " (relative variance " +
           short_number(best.relative_variance) + "): " + names + ".";
}

/// Another file of acdf's that is not visibly noisy either, and better at equal time.
void add_own_finding(const Sweep& sweep, Advice& advice) {
    const SweepRow& best = sweep.rows[advice.recommended.row];
    BaselineComparison fastest;
    for (std::size_t i = 0; i < sweep.rows.size(); ++i) {
        const SweepRow& row = sweep.rows[i];
        if (!row.ours() || !(row.relative_variance <= sweep.visible.largest_variance())) continue;
        const BaselineComparison c = compare(sweep, i, best);
        const bool better = !fastest.equal_time.known() || c.equal_time.value < fastest.equal_time.value;
        if (c.verdict == Verdict::baseline && better) fastest = c;
    }
    if (!fastest.equal_time.known()) return;
    const SweepRow& row = sweep.rows[fastest.row];
    advice.findings.push_back("Where time counts more than size: " + row.label + ", `" + row.options + "`, " +
                              size_text(row) + ", has " + interval_text(fastest.equal_time) +
                              " times the variance of the recommended file at equal time.");
}

void add_findings(const Sweep& sweep, Advice& advice) {
    const SweepRow& best = sweep.rows[advice.recommended.row];
    for (const SituationAdvice& one : advice.situations) advice.findings.push_back(one.sentence);
    if (!advice.situations.empty())
        advice.findings.push_back(
            "The rest of the noise comes from the cosine, which an environment file does not take into account. "
            "Files with a pdf for each normal lower it: see `acdf sweep --kind local`.");
    advice.findings.push_back(sample_finding(sweep, best));
    add_time_findings(sweep, advice, best);
    if (advice.situations.empty()) add_own_finding(sweep, advice);
    if (sweep.kind == SweepKind::brdf)
        advice.findings.push_back(
            "These figures are for uniform light. Under other light, combine the file with samples of the light by "
            "MIS, as its pdfs are exact; `acdf render` compares such samplers on scenes.");
    else if (sweep.kind == SweepKind::visibility)
        advice.findings.push_back(
            "These figures are for the scene as it was when the file was made, with diffuse materials and points "
            "all over it. `acdf render` measures what a camera sees, also with portals and visibility caches. "
            "Where the scene moves, the file stays unbiased and becomes noisier.");
    else if (sweep.kind == SweepKind::local)
        advice.findings.push_back(
            "These figures are without occluders. Where the brightest light is hidden, samplers that follow the "
            "light closely lose most of their lead over a plain CDF. Combine them there with cosine or BRDF "
            "samples by MIS, as the pdfs of the file are exact; `acdf render` compares such samplers on scenes.");
}

} // namespace

std::string size_text(const SweepRow& row) {
    if (row.file_bytes == 0) return to_readable_size(row.bytes);
    return to_readable_size(row.file_bytes) + " (" + to_readable_size(row.bytes) + " in memory)";
}

std::string short_number(double value) {
    if (std::isinf(value)) return "infinite";
    if (!(value == value)) return "unknown";
    char text[32];
    std::snprintf(text, sizeof text, std::abs(value) >= 999.5 || value == 0.0 ? "%.0f" : "%.3g", value);
    if (const char* exponent = std::strstr(text, "e-0")) // "1e-05"
        return std::string(text, static_cast<std::size_t>(exponent - text)) + "e-" + (exponent + 3);
    return text;
}

std::string shell_word(const std::string& word) {
    const bool plain =
        !word.empty() && word.find_first_not_of("abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ"
                                                "0123456789._-/+:=,@%") == std::string::npos;
    if (plain) return word;
    std::string out = "'";
    for (char c : word) out += c == '\'' ? std::string("'\\''") : std::string(1, c);
    return out + "'";
}

Advice advise(const Sweep& sweep) {
    Advice out;
    out.recommended = recommended_row(sweep.rows, sweep.visible, sweep.costs, sweep.numbers);
    const SweepRow& best = sweep.rows[out.recommended.row];
    out.situations = situations_of(sweep, best);
    const bool pictures = !out.situations.empty();
    out.sentence = pictures ? picture_sentence(sweep, out.recommended) : sentence_of(sweep, out.recommended);
    out.rule = pictures ? picture_rule(sweep) : rule_of(sweep);
    out.command = sweep.command + " " + best.options + " -o " + shell_word(sweep.output);
    for (std::size_t i = 0; i < sweep.rows.size(); ++i)
        if (!sweep.rows[i].ours()) out.comparisons.push_back(compare(sweep, i, best));
    add_findings(sweep, out);
    return out;
}

} // namespace acdf::tools
