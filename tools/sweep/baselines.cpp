#include "tools/sweep/baselines.h"

#include "compress/sum.h"
#include "measure/samplers/light_samplers.h"
#include "tools/sweep/estimator.h"

#include <algorithm>
#include <cmath>

namespace acdf::tools {
namespace {

using compress::Target;

/// What a pdf makes of the light itself, as build::measure_environment has it.
struct LightAccuracy {
    double relative_variance = 0.0, max_weight = 0.0, rms = 0.0;
};
LightAccuracy light_accuracy(const Target& target, const std::vector<float>& peaks, const std::vector<float>& pdf) {
    compress::Sum second, error;
    double peak = 0.0;
    bool violated = false;
    const double flux = compress::integral(target);
    for (std::uint32_t r = 0; r < target.rows; ++r)
        for (std::uint32_t c = 0; c < target.columns; ++c) {
            const std::size_t i = std::size_t{r} * target.columns + c;
            const double f = target.values[i], p = pdf[i];
            const double measure = target.row_measure[r] * target.column_measure[c];
            if (f > 0.0 && !(p > 0.0)) {
                violated = true;
            } else if (f > 0.0) {
                second.add(f * f / p * measure);
                peak = std::max(peak, (peaks.empty() ? f : double{peaks[i]}) / p);
            }
            error.add((p - f / flux) * (p - f / flux) * measure);
        }
    LightAccuracy out;
    const double mean_square = target.mean_square > 0.0 ? target.mean_square : flux * flux;
    out.relative_variance = second.value() / mean_square - 1.0;
    // Pdfs and CDFs are floats: a variance as small as their rounding is reported as 0.
    if (out.relative_variance < 1e-9) out.relative_variance = 0.0;
    out.max_weight = peak / std::sqrt(mean_square);
    if (violated) out.relative_variance = out.max_weight = HUGE_VAL;
    out.rms = std::sqrt(error.value() / (4.0 * ACDF_PI));
    return out;
}

} // namespace

std::vector<Candidate> probe_baselines(const Target& target, const std::vector<float>& peaks,
                                       const std::vector<std::uint64_t>& budgets) {
    std::vector<Candidate> out;
    out.push_back(baseline_candidate("full_cdf", "full-resolution CDF", measure::full_cdf_sampler(target)));
    out.push_back(baseline_candidate("alias_table", "alias table", measure::alias_sampler(target)));
    out.push_back(
        baseline_candidate("hierarchical_warp", "hierarchical warp", measure::hierarchical_sampler(target)));
    out.push_back(baseline_candidate("mis_compensation", "compensated CDF", measure::compensated_sampler(target)));
    out.back().row.needs_mis = true;
    for (std::uint64_t budget : budgets) {
        const double side = std::sqrt(static_cast<double>(budget) / 8.0 / 2.0); // eight bytes a cell, 2:1
        const auto rows = static_cast<std::uint32_t>(std::lround(side));
        if (rows < 2 || rows >= target.rows || 2 * rows >= target.columns) continue;
        out.push_back(baseline_candidate(
            "downsampled_cdf", "CDF downsampled to " + std::to_string(2 * rows) + " x " + std::to_string(rows),
            measure::downsampled_cdf_sampler(target, 2 * rows, rows)));
    }
    for (Candidate& candidate : out) {
        const LightAccuracy accuracy = light_accuracy(target, peaks, texel_pdfs(target, *candidate.sampler));
        candidate.row.relative_variance = accuracy.relative_variance;
        candidate.row.max_weight = accuracy.max_weight;
        candidate.row.rms = accuracy.rms;
    }
    for (std::uint32_t columns : {32u, 64u}) {
        if (columns > target.columns || columns / 2 > target.rows) continue;
        const std::string tiles = std::to_string(columns * columns / 2);
        out.push_back(baseline_candidate("tiling_" + tiles, tiles + " tiles weighted on the fly",
                                         measure::tiling_sampler(target, columns, columns / 2)));
        out.back().row.needs = Given::normal;
    }
    return out;
}

} // namespace acdf::tools
