// Fits of a two-dimensional target: a marginal curve over one axis, conditional curves over the other.
#pragma once

#include "compress/cascade.h"
#include "compress/store/store.h"
#include "compress/target.h"

#include <acdf/layout.h>

#include <cstdint>
#include <functional>
#include <optional>

namespace acdf::compress {

/// Which axis is split first.
enum class Order { phi, z };

/// How the rows of a region of the marginal are averaged into one conditional. The paper's eq. 4 gives every
/// row the same weight; weighting rows by their energy is the region's own conditional, and costs less.
enum class Conditional { energy, mean };

/// Called from one thread at a time with the finished share in [0, 1].
using Progress = std::function<void(double)>;

/// What the variance fit is to reach.
struct Goal {
    enum class Kind { cells, budget, variance };

    Kind kind = Kind::cells;
    std::uint32_t cells = 4096; ///< cells: at most so many
    std::uint64_t budget = 0;   ///< budget: the file takes at most so many bytes
    double variance = 0.0;      ///< variance: the stored pdf's relative variance is at most this
};

struct FitOptions {
    AcdfFit fit = ACDF_FIT_VARIANCE;
    std::optional<Order> order;                    ///< of the others; empty: phi
    Goal goal;                                     ///< variance
    double max_weight = 0.0;                       ///< variance: the largest f/p over its mean; 0: no bound
    std::uint32_t column_segments = 64;            ///< uniform, cdf, pdf: segments of a curve over columns (phi)
    std::uint32_t row_segments = 64;               ///< the same over rows (theta)
    double epsilon = 0.0;                          ///< cdf, pdf: see CurveBudget
    Conditional conditional = Conditional::energy; ///< uniform, cdf, pdf
    std::uint32_t gradient_knots = 0;              ///< cdf, pdf: extra marginal knots (Lawrence et al. 2005, eq. 5)
    Progress progress;
};

/// A fit, and how it is stored.
struct Fitted {
    Cascade cascade;
    EncodedTree tree;
};

/// Fits `target` (rows are theta, columns phi) by uniform, cdf or pdf. Deterministic for any number of threads.
/// Throws std::invalid_argument for other fits, and where the target has no energy.
Fitted fit(const Target& target, const FitOptions& options);

/// Fits uniform, cdf and pdf: marginal over the target's rows, one conditional over columns for each region
/// between its knots (Lawrence et al. 2005, §5).
Cascade fit_regional(const Target& target, const FitOptions& options);

} // namespace acdf::compress
