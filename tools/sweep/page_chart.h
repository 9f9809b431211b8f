// Plots of a sweep's rows as inline SVG: size along x, anything along y, both logarithmic.
#pragma once

#include "tools/sweep/sweep.h"
#include "tools/sweep/timing.h"

#include <string>
#include <vector>

namespace acdf::tools {

/// Rows that are plotted alike: a fit's, connected, or those of one baseline.
struct ReportSeries {
    bool ours = false;
    std::size_t index = 0; ///< among fits, or among baselines: gives shape and colour, or the letter
    std::string label;
    std::vector<std::size_t> rows; ///< by size

    std::string letter() const; ///< of a baseline: A, B, ...
};
std::vector<ReportSeries> series_of(const Sweep& sweep);

struct Chart {
    std::string id;    ///< of the HTML element, and of its points' data-chart
    std::string title; ///< for people
    std::string about; ///< one sentence: what the plot shows
    std::string y_label;
    Interval (*value)(const Sweep& sweep, const SweepRow& row); ///< unknown: no point; low and high may be unknown
    double limit = kUnknown;                                    ///< a horizontal line
    std::string limit_label = {};
};

/// A row is a point wherever its value is known; each carries data-row, data-system, data-file, data-bytes,
/// data-variance and data-value with the numbers of sweep.csv. Values of 0 and infinity, and sizes below a KiB, lie
/// on strips of their own at the edge. Empty where there is no point.
std::string chart_svg(const Sweep& sweep, const Chart& chart, const std::vector<std::size_t>& recommended);

/// What a series looks like in a plot, for the legend.
std::string series_mark(const ReportSeries& series);

} // namespace acdf::tools
