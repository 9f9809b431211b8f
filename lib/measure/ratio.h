// Ratios of noisy figures, with their own noise.
#pragma once

#include <cstddef>
#include <vector>

namespace acdf::measure {

/// A figure and its 95 % confidence interval.
struct Interval {
    double value = 0.0, low = 0.0, high = 0.0;
};

/// The mean of independent measurements (at least two), by Student's t.
Interval mean_interval(const std::vector<double>& measured);

/// mean(a) / mean(b) of independent measurements, at least two of each, all >= 0: the logarithm's interval by the
/// delta method and Student's t with the fewer degrees of freedom. Where a mean is 0 the interval is [0, infinity].
Interval ratio_interval(const std::vector<double>& a, const std::vector<double>& b);

/// The product of two independent ratios; their logarithms' half widths add up as squares.
Interval product(const Interval& a, const Interval& b);

/// Half of the 95 % interval of Student's t, in standard errors.
double student_t(std::size_t degrees);

} // namespace acdf::measure
