// The variance fit of a BRDF: one tree of halvings of half-vectors, with a row of codes for each stored view
// (docs/notes/brdf-method.md).
#pragma once

#include "compress/brdf/mixtures.h"
#include "compress/brdf/view_costs.h"
#include "compress/brdf/weights.h"
#include "compress/halvings/rows.h"

#include <cstddef>
#include <cstdint>

namespace acdf::compress {

/// How large the parts of a fit become.
struct HalvedBrdfSize {
    std::uint64_t bytes = 0; ///< of HALV and NORM together, at most; 0: it is `cells` that count
    std::uint32_t cells = 0; ///< that each view has for itself
};

/// What BINS and VIEW do not say of a file.
struct HalvedBrdf {
    RowHalvings rows;
    double relative_variance = 0.0; ///< as estimated over the views that were fitted
};

/// Deterministic for any number of threads. Throws std::runtime_error where no tree fits.
HalvedBrdf fit_halved_brdf(const BrdfViews& views, const HorizonSquares& horizon, const ViewMixtures& mixtures,
                           const HalvedBrdfSize& size, double max_weight);

} // namespace acdf::compress
