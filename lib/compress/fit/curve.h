// Fits of one curve: which knots, and what probability each segment gets.
#pragma once

#include "compress/cascade.h"

#include <cstdint>
#include <vector>

namespace acdf::compress {

/// A 1D distribution on grid steps: `mass[i]` >= 0 (any scale, not all 0) over a step of size `measure[i]` > 0.
struct Distribution {
    std::vector<double> mass;
    std::vector<double> measure;
};

/// How fine a curve may become.
struct CurveBudget {
    std::uint32_t segments = 64;
    double epsilon = 0.0; ///< fits cdf and pdf stop once nothing deviates by more
};

/// `segments` segments of (nearly) equally many grid steps.
Curve fit_curve_uniform(const Distribution& distribution, const CurveBudget& budget);

/// Douglas-Peucker on the CDF: the pdf is constant on each segment (Lawrence et al. 2005, §4.2).
/// epsilon is in units of cumulative probability.
Curve fit_curve_cdf(const Distribution& distribution, const CurveBudget& budget);

/// Douglas-Peucker on the PDF: the pdf is linear on each segment (ibid.). epsilon is relative to the
/// largest pdf. Each segment keeps its exact mass, so that nothing needs renormalising and nothing with
/// energy gets pdf 0; its slope is the one that minimises the integral of f^2/p.
Curve fit_curve_pdf(const Distribution& distribution, const CurveBudget& budget);

/// A curve with the given interior knots whose segments carry their mass.
Curve curve_through(const Distribution& distribution, std::vector<std::uint32_t> knots);

/// The slope s in (-1, 1) for which the pdf 1 + s (2t - 1) on steps [begin, end) costs least:
/// argmin of the integral of f^2 / (1 + s (2t - 1)).
double best_tilt(const Distribution& distribution, std::uint32_t begin, std::uint32_t end);

} // namespace acdf::compress
