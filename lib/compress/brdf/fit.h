// The fit of a BRDF: which views are stored, what they share, and a row for each.
#pragma once

#include "compress/brdf/target.h"
#include "compress/fit/fit.h"
#include "compress/halvings/rows.h"

#include <cstdint>
#include <functional>
#include <vector>

namespace acdf::compress {

/// A BRDF as it is stored.
struct BrdfFit {
    std::vector<float> nodes;    ///< x = sqrt(1 - cos(theta_o)) of the stored views, increasing
    std::uint32_t phi_views = 1; ///< azimuths -pi + 2 pi k / phi_views; 1: isotropic
    bool mirrored = true;
    RowHalvings rows;               ///< variance: a tree of halvings, and a row a bin
    EncodedTree tree;               ///< other fits: one root a bin
    std::vector<float> shares;      ///< of the bins' albedos in their sum
    double total = 0.0;             ///< that sum
    double relative_variance = 0.0; ///< as estimated over the views that were fitted

    bool halved() const { return !rows.halvings.axes.empty(); }
    std::uint32_t bins() const { return static_cast<std::uint32_t>(nodes.size()) * phi_views; }
};

/// A bound on weights that costs next to nothing: docs/brdf.md.
constexpr double kUsualMaxWeight = 20.0;

struct BrdfOptions {
    AcdfFit fit = ACDF_FIT_VARIANCE;
    BrdfSymmetry symmetry;
    Goal goal; ///< variance; cells: that each bin has for itself
    /// Stored views in theta_o and phi_o; 0: as the fit sees fit (uniform, cdf, pdf: 32, or 32 x 16, as in Lawrence
    /// et al. 2005, §6.2).
    std::uint32_t theta_views = 0, phi_views = 0;
    /// Variance: what no weight is to be above, over their mean, of the views that the fit looks at.
    double max_weight = kUsualMaxWeight;
    std::uint32_t theta_segments = 30, phi_segments = 10; ///< uniform, cdf, pdf: of a curve over theta_h and phi_h
    double epsilon = 0.0;                                 ///< cdf, pdf: see CurveBudget
    std::function<std::uint64_t(const BrdfFit&)> file_size;
    Progress progress;
};

/// Deterministic for any number of threads. Throws std::invalid_argument where nothing is reflected or a value is
/// not finite, std::runtime_error where the goal is out of reach.
BrdfFit fit_brdf(const Reflected& reflected, const BrdfOptions& options);

} // namespace acdf::compress
