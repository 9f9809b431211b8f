#include "tools/sweep/cost.h"

namespace acdf::tools {

std::vector<double> sample_times(const SweepRow& row, Estimator estimator, const SampleCosts& costs) {
    std::vector<double> out = row.times.sample;
    if (estimator == with_mis && row.times.pdf.size() != out.size()) return {};
    for (std::size_t i = 0; i < out.size(); ++i) {
        if (estimator == with_mis) out[i] = 0.5 * (out[i] + row.times.pdf[i] + costs.cosine_ns);
        out[i] += costs.shadow_ray_ns;
    }
    return out;
}

Interval cost_ratio(const SweepRow& a, const SweepRow& b, Estimator estimator, const SampleCosts& costs) {
    return ratio_interval(sample_times(a, estimator, costs), sample_times(b, estimator, costs));
}

} // namespace acdf::tools
