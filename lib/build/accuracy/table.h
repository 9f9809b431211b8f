// How far the stored pdfs of a table are from the table, by summation over every number of it.
#pragma once

#include "compress/grid.h"

#include <acdf/accuracy.h>
#include <acdf/reader.h>
#include <acdf/views.h>

#include <cstdint>
#include <vector>

namespace acdf::build {

/// Accuracy of one bin: p is its stored pdf, f its part of the table, p* = f / (integral of f).
struct BinAccuracy {
    /// Variance of one sample of the estimator f/p, over (integral of f)^2. Infinite with a support violation.
    double relative_variance = 0.0;
    double square_error = 0.0;            ///< mean over the bin of (p - p*)^2, with the whole bin as unit of volume
    double kl_divergence = 0.0;           ///< integral of p* ln(p*/p), nats
    double max_weight = 0.0;              ///< largest f/p over its mean
    std::uint64_t support_violations = 0; ///< numbers f > 0 where p = 0
    std::uint64_t cells = 0;
    bool lit = false; ///< whether the bin has any energy; else all of the above is 0
};

using TableAccuracy = builder::TableAccuracy;

/// Compares a table file with `bins`, one grid a bin, their axes the sampled ones in order. Only the ratios of
/// their values and of their measures matter. Throws std::invalid_argument where shapes differ or nothing has
/// energy. The same for any number of threads.
std::vector<BinAccuracy> measure_bins(const File& file, const std::vector<compress::Grid>& bins);
/// Throws std::invalid_argument where shapes differ.
void check_shapes(const File& file, const std::vector<compress::Grid>& bins);
TableAccuracy summary(const std::vector<BinAccuracy>& bins);

} // namespace acdf::build
