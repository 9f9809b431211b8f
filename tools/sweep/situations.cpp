#include "tools/sweep/situations.h"

#include "tools/cli/noise.h"
#include "tools/sweep/advice.h"
#include "tools/sweep/recommend.h"

#include <algorithm>
#include <cmath>

namespace acdf::tools {
namespace {

/// Variance of `other` over that of `best`, after the same time or, untimed, the same samples.
Interval variance_ratio(const Sweep& sweep, const SweepRow& other, const SweepRow& best, Situation situation) {
    const double ratio = variance_in(other, situation, sweep.numbers) / variance_in(best, situation, sweep.numbers);
    if (!sweep.timed) return {ratio, ratio, ratio};
    const Interval cost = cost_ratio(other, best, situation, sweep.costs);
    if (!cost.known()) return {};
    return {ratio * cost.value, ratio * cost.low, ratio * cost.high};
}

const char* where_text(Situation situation) {
    switch (situation) {
    case open_alone:
        return "Nothing hidden, samples of the light alone";
    case open_partner:
        return "Nothing hidden, half of the samples from the cosine (MIS, balance heuristic)";
    case hidden_alone:
        return "Behind the demo scene's sphere and wall, samples of the light alone";
    default:
        return "Behind the demo scene's sphere and wall, half of the samples from the cosine";
    }
}

std::string sentence_of(const Sweep& sweep, const SituationAdvice& s) {
    const SweepRow& base = sweep.rows[sweep.reference];
    std::string text = std::string(where_text(s.situation)) + ": " + noise_texts(s.lit.mean) +
                       " noise at 16, 64, 256 "
                       "independent samples (median point: " +
                       noise_texts(s.lit.median) + ")";
    if (s.lit.sobol == s.lit.sobol)
        text += ", " + noise_text(s.lit.sobol, sweep.visible.spp) + " at " + std::to_string(sweep.visible.spp) +
                " samples of a scrambled Sobol' sequence";
    const char* after = sweep.timed ? "At equal time: " : "At equal samples: ";
    text += std::string(". ") + after + noise_ratio_text(s.over_reference.value) + " the " + base.label;
    if (!s.has_baseline) return text + ".";
    const bool even = s.over_best_baseline.low < 1.0 && s.over_best_baseline.high > 1.0;
    return text + ", " + noise_ratio_text(s.over_best_baseline.value) + " the best baseline, the " +
           sweep.rows[s.best_baseline].label + (even ? " (too close to call)." : ".");
}

} // namespace

const char* to_string(Situation situation) {
    constexpr const char* names[kSituations] = {"open", "open_partner", "hidden", "hidden_partner"};
    return names[situation];
}

std::string noise_ratio_text(double variance_ratio) {
    if (!(variance_ratio == variance_ratio)) return "an unknown noise ratio to";
    if (std::isinf(variance_ratio)) return "no bias, unlike";
    const double ratio = std::sqrt(variance_ratio);
    if (ratio > 1.0 / 1.005 && ratio < 1.005) return "the same noise as";
    return ratio > 1.0 ? short_number(ratio) + " times less noise than"
                       : short_number(1.0 / ratio) + " times more noise than";
}

std::vector<SituationAdvice> situations_of(const Sweep& sweep, const SweepRow& best) {
    std::vector<SituationAdvice> out;
    if (!(best.lit[open_alone].mean == best.lit[open_alone].mean)) return out;
    for (std::size_t i = 0; i < kSituations; ++i) {
        SituationAdvice one;
        one.situation = static_cast<Situation>(i);
        one.lit = best.lit[i];
        one.over_reference = variance_ratio(sweep, sweep.rows[sweep.reference], best, one.situation);
        for (std::size_t r = 0; r < sweep.rows.size(); ++r) {
            if (sweep.rows[r].ours()) continue;
            const Interval ratio = variance_ratio(sweep, sweep.rows[r], best, one.situation);
            if (!ratio.known() || std::isinf(ratio.value)) continue;
            if (one.has_baseline && ratio.value >= one.over_best_baseline.value) continue;
            one.best_baseline = r;
            one.has_baseline = true;
            one.over_best_baseline = ratio;
        }
        one.sentence = sentence_of(sweep, one);
        out.push_back(std::move(one));
    }
    return out;
}

} // namespace acdf::tools
