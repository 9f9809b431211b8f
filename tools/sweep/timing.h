// How long samplers take, side by side.
#pragma once

#include "measure/samplers/light_sampler.h"
#include "tools/sweep/sweep.h"

#include <vector>

namespace acdf::tools {

/// A median, and an interval that holds the true one with 95 % confidence.
struct Interval {
    double value = kUnknown, low = kUnknown, high = kUnknown;

    bool known() const { return value == value; }
};

/// Of numbers that are independent: the interval is between order statistics chosen by the binomial distribution of
/// how many lie below the median, whatever their own distribution. Unknown where there are none; below six the
/// interval is their range, which is less than 95 %.
Interval median_interval(std::vector<double> values);

/// Of a[i] / b[i]; of as many as both have.
Interval ratio_interval(const std::vector<double>& a, const std::vector<double>& b);

/// What is timed: at each point `kSamplesAPoint` samples, and as many pdfs of directions around the normal;
/// moving to the point is shared by them.
constexpr std::uint32_t kSamplesAPoint = 16;

/// One thread. In each round every sampler runs once, in an order that changes from round to round: whatever slows
/// the machine for a while slows all of them. A round before the first is thrown away, and so are as many samples
/// before each that are timed.
std::vector<SweepTimes> time_samplers(const std::vector<const measure::LightSampler*>& samplers,
                                      const std::vector<measure::ShadingPoint>& points, std::uint32_t rounds,
                                      const build::Progress& progress = {});

} // namespace acdf::tools
