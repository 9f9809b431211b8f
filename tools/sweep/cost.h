// What a row's variance is worth after the same time.
#pragma once

#include "tools/sweep/sweep.h"
#include "tools/sweep/timing.h"

#include <vector>

namespace acdf::tools {

/// ns of a sample, all that it costs included, one a round; with MIS half of the samples are the BSDF's, and all
/// need both pdfs. Empty where it was not timed.
std::vector<double> sample_times(const SweepRow& row, Estimator estimator, const SampleCosts& costs);

/// How many times as long as one of `b` a sample of `a` takes. Unknown where it was not timed.
Interval cost_ratio(const SweepRow& a, const SweepRow& b, Estimator estimator, const SampleCosts& costs);

} // namespace acdf::tools
