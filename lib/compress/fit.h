// Fits of a two-dimensional target: a marginal curve over one axis, conditional curves over the other.
#pragma once

#include "compress/cascade.h"
#include "compress/target.h"

#include <acdf/layout.h>

#include <cstdint>
#include <functional>

namespace acdf::compress {

/// Which axis is split first; the other one is refined within each of its segments.
enum class Order { phi, z };

/// How the rows of a region of the marginal are averaged into one conditional. The paper's eq. 4 gives every
/// row the same weight; weighting rows by their energy is the region's own conditional, and costs less.
enum class Conditional { energy, mean };

/// Called from one thread at a time with the finished share in [0, 1].
using Progress = std::function<void(double)>;

struct FitOptions {
    AcdfFit fit = ACDF_FIT_VARIANCE;
    Order order = Order::z;
    std::uint32_t cells = 4096;                    ///< variance: cells in all
    std::uint32_t column_segments = 64;            ///< uniform, cdf, pdf: segments of a curve over columns (phi)
    std::uint32_t row_segments = 64;               ///< the same over rows (theta)
    double epsilon = 0.0;                          ///< cdf, pdf: see CurveBudget
    Conditional conditional = Conditional::energy; ///< uniform, cdf, pdf
    std::uint32_t gradient_knots = 0;              ///< cdf, pdf: extra marginal knots (Lawrence et al. 2005, eq. 5)
    Progress progress;
};

/// Fits `target` (rows are theta, columns phi; integral > 0). Deterministic for any number of threads.
Cascade fit(const Target& target, const FitOptions& options);

/// Fits uniform, cdf and pdf: marginal over the target's rows, one conditional over columns for each region
/// between its knots (Lawrence et al. 2005, §5).
Cascade fit_regional(const Target& target, const FitOptions& options);

/// The minimum-variance cascade of fixed depth: docs/method.md.
Cascade fit_variance(const Target& target, const FitOptions& options);

} // namespace acdf::compress
