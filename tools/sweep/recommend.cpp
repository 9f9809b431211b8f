#include "tools/sweep/recommend.h"

#include "tools/commands.h"

#include <algorithm>
#include <cmath>

namespace acdf::tools {
namespace {

bool known(double value) { return value == value; }

/// ns of a sample, one a round.
std::vector<double> sample_times(const SweepRow& row, Situation situation, const SampleCosts& costs) {
    const bool partner = situation == open_partner || situation == hidden_partner;
    std::vector<double> out = row.times.sample;
    if (partner && row.times.pdf.size() != out.size()) return {};
    for (std::size_t i = 0; i < out.size(); ++i) {
        if (partner) out[i] = 0.5 * (out[i] + row.times.pdf[i] + costs.cosine_ns);
        out[i] += costs.shadow_ray_ns;
    }
    return out;
}

/// How much more than the least noise of all files a row has, in the worst situation; noise that cannot be seen
/// counts as the least.
std::vector<double> excess_noise(const std::vector<SweepRow>& rows, const VisibleNoise& visible,
                                 const SampleCosts& costs, measure::Numbers numbers) {
    std::vector<double> out(rows.size(), HUGE_VAL);
    for (std::size_t i = 0; i < rows.size(); ++i)
        if (rows[i].ours()) out[i] = 1.0;
    for (std::size_t s = 0; s < kSituations; ++s) {
        const auto situation = static_cast<Situation>(s);
        std::vector<double> costly(rows.size(), HUGE_VAL);
        double least = HUGE_VAL;
        for (std::size_t i = 0; i < rows.size(); ++i) {
            if (!rows[i].ours()) continue;
            const std::vector<double> times = sample_times(rows[i], situation, costs);
            const double time = times.empty() ? 1.0 : median_interval(times).value;
            costly[i] = variance_in(rows[i], situation, numbers) * time;
            least = std::min(least, costly[i]);
        }
        for (std::size_t i = 0; i < rows.size(); ++i)
            if (variance_in(rows[i], situation, numbers) > visible.largest_variance() && costly[i] > least)
                out[i] = std::max(out[i], std::sqrt(costly[i] / least));
    }
    return out;
}

bool invisible(const SweepRow& row, const VisibleNoise& visible, measure::Numbers numbers) {
    for (std::size_t s = 0; s < kSituations; ++s)
        if (!(variance_in(row, static_cast<Situation>(s), numbers) <= visible.largest_variance())) return false;
    return true;
}

Recommended for_pictures(const std::vector<SweepRow>& rows, const VisibleNoise& visible, const SampleCosts& costs,
                         measure::Numbers numbers) {
    const std::vector<double> excess = excess_noise(rows, visible, costs, numbers);
    double smallest = HUGE_VAL; // of those that are good enough
    for (std::size_t i = 0; i < rows.size(); ++i)
        if (excess[i] <= kSameNoise) smallest = std::min(smallest, static_cast<double>(rows[i].bytes));
    std::size_t best = rows.size();
    for (std::size_t i = 0; i < rows.size(); ++i) {
        const bool fits = excess[i] <= kSameNoise && static_cast<double>(rows[i].bytes) <= kSameSize * smallest;
        if (!rows[i].ours() || (!fits && !std::isinf(smallest))) continue;
        if (best == rows.size() || excess[i] < excess[best]) best = i;
    }
    return {best, invisible(rows[best], visible, numbers)};
}

} // namespace

double variance_in(const SweepRow& row, Situation situation, measure::Numbers numbers) {
    const Lit& lit = row.lit[situation];
    const bool sobol = numbers == measure::Numbers::sobol;
    if (!known(lit.mean)) return sobol && known(row.sobol) ? row.sobol : row.relative_variance;
    return sobol && known(lit.sobol) ? lit.sobol : lit.mean;
}

Interval cost_ratio(const SweepRow& a, const SweepRow& b, Situation situation, const SampleCosts& costs) {
    return ratio_interval(sample_times(a, situation, costs), sample_times(b, situation, costs));
}

Recommended recommended_row(const std::vector<SweepRow>& rows, const VisibleNoise& visible,
                            const SampleCosts& costs, measure::Numbers numbers) {
    for (const SweepRow& row : rows)
        if (row.ours() && known(row.lit[open_alone].mean)) return for_pictures(rows, visible, costs, numbers);
    Recommended out;
    bool found = false;
    for (std::size_t i = 0; i < rows.size(); ++i) {
        const double variance = variance_in(rows[i], open_alone, numbers);
        if (!rows[i].ours() || !known(variance)) continue;
        const bool reached = variance <= visible.largest_variance();
        const SweepRow& best = rows[out.row];
        const bool better = !found || (reached != out.reached ? reached
                                       : reached              ? rows[i].bytes < best.bytes
                                                              : variance < variance_in(best, open_alone, numbers));
        if (better) out = {i, reached};
        found = true;
    }
    if (!found) throw Failure("none of the files has a known variance");
    return out;
}

} // namespace acdf::tools
