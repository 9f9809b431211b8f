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

/// How many times as long as one of `b` a sample of `a` takes, all that it costs included; with an MIS partner half
/// of the samples are the surface's, and all need the density of both. Unknown where it was not timed.
Interval cost_ratio(const SweepRow& a, const SweepRow& b, Situation situation, const SampleCosts& costs);

struct Recommended {
    std::size_t row = 0;
    bool reached = false; ///< its noise is too small to see
};

/// No file is better by more in noise than this: it would not be seen.
constexpr double kSameNoise = 1.05;
/// Nor smaller than this: of such files the least noisy one is taken.
constexpr double kSameSize = 1.25;

/// Environment: the smallest file whose noise on a diffuse surface is in no situation more than kSameNoise times
/// the least of all files after the same time, or too small to see, but for kSameSize; where there is none the one
/// that misses by least. Otherwise the smallest file whose variance_in() is at most
/// visible.largest_variance(), or the least noisy. There must be a file of known variance.
Recommended recommended_row(const std::vector<SweepRow>& rows, const VisibleNoise& visible,
                            const SampleCosts& costs = {},
                            measure::Numbers numbers = measure::Numbers::independent);

} // namespace acdf::tools
