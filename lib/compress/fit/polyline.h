// Douglas-Peucker approximation of a curve given at grid positions.
#pragma once

#include <cstdint>
#include <vector>

namespace acdf::compress {

/// Interior knots (ascending) of a polyline through some of the points (x[i], y[i]), i in [0, n): starts from
/// the two end points and inserts the point that deviates most, measured along y, until `segments` are
/// reached or no point deviates by more than `epsilon` (Douglas and Peucker 1973; Lawrence et al. 2005, §4.1).
/// Ties go to the lower index. x ascends.
std::vector<std::uint32_t> douglas_peucker(const std::vector<double>& x, const std::vector<double>& y,
                                           std::uint32_t segments, double epsilon);

} // namespace acdf::compress
