// Pdfs that are linear across a cell, one grid step after the other.
#pragma once

#include <acdf/curves/tree.h>

#include <cstdint>
#include <vector>

namespace acdf::build {

/// Means over one grid step of functions of the tilt pdf g, which is linear there.
struct StepMeans {
    double g = 1.0, square = 1.0, reciprocal = 1.0, logarithm = 0.0, smallest = 1.0;
};

/// StepMeans of each grid step in a cell's range on one axis, whose steps have `measure`.
void range_means(const AcdfTiltedRange& range, const std::vector<double>& measure, std::vector<StepMeans>& out);

} // namespace acdf::build
