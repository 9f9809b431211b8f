// Which file of a sweep to make, and what a row's variance is worth after the same time.
#pragma once

#include "tools/sweep/sweep.h"
#include "tools/sweep/timing.h"

#include <string>
#include <vector>

namespace acdf::tools {

/// Of one sample, mean over points, with the numbers by which the advice goes; where nothing is known of situations
/// (local, BRDF) what a surface reflects anyway.
double variance_in(const SweepRow& row, Situation situation, measure::Numbers numbers);

/// The time of a sample of `a` over that of a sample of `b`, with all that it costs. With an MIS partner half of
/// the samples are the surface's, and all need both pdfs. Unknown where it was not timed.
Interval cost_ratio(const SweepRow& a, const SweepRow& b, Situation situation, const SampleCosts& costs);

struct Recommended {
    std::size_t row = 0;
    bool reached = false; ///< its noise is too small to see
};

/// A file whose noise is lower by less than this factor is not better: nobody would see it.
constexpr double kSameNoise = 1.05;
/// Of files whose sizes differ by less than this factor the least noisy one is taken.
constexpr double kSameSize = 1.25;

/// Environment: the smallest file whose noise on a diffuse surface is low enough in all situations, but for
/// kSameSize. Low enough is at most kSameNoise times the least of all files after the same time, or too small to
/// see. Where there is no such file, the one that misses by least. Otherwise the smallest file whose variance_in()
/// is at most visible.largest_variance(), or the least noisy. There must be a file of known variance.
Recommended recommended_row(const std::vector<SweepRow>& rows, const VisibleNoise& visible,
                            const SampleCosts& costs = {},
                            measure::Numbers numbers = measure::Numbers::independent);

} // namespace acdf::tools
