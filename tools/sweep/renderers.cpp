#include "tools/sweep/renderers.h"

#include "tools/cli/noise.h"
#include "tools/cli/sizes.h"
#include "tools/sweep/advice.h"
#include "tools/sweep/cost.h"

#include <algorithm>
#include <cmath>

namespace acdf::tools {
namespace {

bool serves(const SweepRow& row, const RendererKind& renderer) {
    return row.needs <= renderer.given && (renderer.mis || !row.needs_mis);
}

/// Variance times time, or variance alone where nothing was timed.
double cost(const Sweep& sweep, const SweepRow& row, const RendererKind& renderer) {
    const double variance = case_mean(sweep, row, renderer.estimator());
    const std::vector<double> times = sample_times(row, renderer.estimator(), sweep.costs);
    return times.empty() ? variance : variance * median_interval(times).value;
}

/// The row of least cost that `wanted` accepts; none where all are biased.
template <class Wanted>
std::optional<std::size_t> best_row(const Sweep& sweep, const RendererKind& renderer, const Wanted& wanted) {
    std::optional<std::size_t> best;
    double least = HUGE_VAL;
    for (std::size_t i = 0; i < sweep.rows.size(); ++i) {
        const SweepRow& row = sweep.rows[i];
        if (!serves(row, renderer) || !wanted(row)) continue;
        const double c = cost(sweep, row, renderer);
        if (!(c < least)) continue;
        least = c;
        best = i;
    }
    return best;
}

std::size_t smallest_as_good(const Sweep& sweep, const RendererKind& renderer, std::size_t best) {
    const double enough = kSameNoise * kSameNoise * cost(sweep, sweep.rows[best], renderer);
    std::size_t out = best;
    for (std::size_t i = 0; i < sweep.rows.size(); ++i) {
        const SweepRow& row = sweep.rows[i];
        if (row.ours() && row.file == sweep.rows[best].file && row.bytes < sweep.rows[out].bytes &&
            cost(sweep, row, renderer) <= enough)
            out = i;
    }
    return out;
}

Interval variance_ratio(const Sweep& sweep, std::size_t other, std::size_t best, Estimator estimator) {
    const SweepRow &a = sweep.rows[other], &b = sweep.rows[best];
    const double ratio = case_mean(sweep, a, estimator) / case_mean(sweep, b, estimator);
    if (!sweep.timed) return {ratio, ratio, ratio};
    const Interval time = cost_ratio(a, b, estimator, sweep.costs);
    return {ratio * time.value, ratio * time.low, ratio * time.high};
}

/// ", 1.4 times less noise than acdf env, 64 KiB".
std::string beside(const Sweep& sweep, const Rival& rival) {
    const SweepRow& row = sweep.rows[rival.row];
    std::string text = ", " + noise_ratio_text(rival.variance.value) + " " + row.label;
    if (row.ours()) text += " of " + to_readable_size(row.file_bytes);
    const bool even = rival.variance.low < 1.0 && rival.variance.high > 1.0;
    return text + (even ? " (too close to call)" : "");
}

std::string sentence_of(const Sweep& sweep, const RendererAdvice& advice) {
    const SweepRow& row = sweep.rows[advice.row];
    std::string text = row.label + ", " + size_text(row) + ": " + noise_text(advice.variance, sweep.visible.spp) +
                       " noise at " + std::to_string(sweep.visible.spp) + " samples";
    text += sweep.timed ? "; after the same time " : "; after the same samples ";
    text += noise_ratio_text(advice.over_reference.value) + " the " + sweep.rows[sweep.reference].label;
    if (advice.baseline && advice.baseline->row != sweep.reference) text += beside(sweep, *advice.baseline);
    if (advice.other) text += beside(sweep, *advice.other);
    return text + ".";
}

} // namespace

std::string to_string(const RendererKind& renderer) {
    constexpr const char* given[] = {"", "_normal", "_position"};
    return std::string(renderer.mis ? "mis" : "alone") + given[static_cast<std::size_t>(renderer.given)];
}

std::string renderer_text(const RendererKind& renderer) {
    constexpr const char* given[] = {"no normal", "normal", "normal and position"};
    return std::string(renderer.mis ? "MIS, " : "no MIS, ") + given[static_cast<std::size_t>(renderer.given)];
}

double case_mean(const Sweep& sweep, const SweepRow& row, Estimator estimator) {
    double logarithms = 0.0;
    std::size_t count = 0;
    for (std::size_t c = 0; c < kCases; ++c) {
        if (sweep.on_mesh && (c == diffuse_open || c == glossy_open)) continue;
        const Noise& noise = row.noise[estimator][c];
        const double variance = sweep.numbers == measure::Numbers::sobol ? noise.sobol : noise.exact;
        logarithms += std::log(std::max(variance, sweep.visible.largest_variance()));
        ++count;
    }
    return std::exp(logarithms / static_cast<double>(count));
}

std::vector<RendererAdvice> advise_renderers(const Sweep& sweep) {
    std::vector<RendererAdvice> out;
    if (sweep.kind != SweepKind::probe) return out;
    for (const Given given : {Given::nothing, Given::normal, Given::position})
        for (const bool mis : {false, true}) {
            if (given == Given::position && !sweep.on_mesh) continue;
            RendererAdvice one;
            one.renderer = {mis, given};
            const auto best = best_row(sweep, one.renderer, [](const SweepRow& row) { return row.ours(); });
            if (!best) continue;
            one.row = smallest_as_good(sweep, one.renderer, *best);
            const SweepRow& row = sweep.rows[one.row];
            const Estimator estimator = one.renderer.estimator();
            one.variance = case_mean(sweep, row, estimator);
            one.over_reference = variance_ratio(sweep, sweep.reference, one.row, estimator);
            if (const auto other = best_row(sweep, one.renderer,
                                            [&](const SweepRow& r) { return r.ours() && r.file != row.file; }))
                one.other = Rival{*other, variance_ratio(sweep, *other, one.row, estimator)};
            if (const auto other = best_row(sweep, one.renderer, [](const SweepRow& r) { return !r.ours(); }))
                one.baseline = Rival{*other, variance_ratio(sweep, *other, one.row, estimator)};
            one.sentence = sentence_of(sweep, one);
            one.command = command_text(sweep, row);
            out.push_back(std::move(one));
        }
    return out;
}

std::string command_text(const Sweep& sweep, const SweepRow& row) {
    const char* ending = row.needs == Given::nothing  ? ".acdf"
                         : row.needs == Given::normal ? ".local.acdf"
                                                      : ".visibility.acdf";
    return "acdf " + row.command + " " + sweep.input + " " + row.options + " -o " +
           shell_word(sweep.output + ending);
}

std::string noise_ratio_text(double variance_ratio) {
    if (!(variance_ratio == variance_ratio)) return "unknown noise beside";
    if (std::isinf(variance_ratio)) return "no bias, unlike";
    const double ratio = std::sqrt(variance_ratio);
    if (ratio > 1.0 / 1.005 && ratio < 1.005) return "the same noise as";
    return ratio > 1.0 ? short_number(ratio) + " times less noise than"
                       : short_number(1.0 / ratio) + " times more noise than";
}

} // namespace acdf::tools
