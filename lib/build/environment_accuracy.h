// How far a stored density is from its target, by summation over every texel: no samples, no noise.
#pragma once

#include "compress/target.h"

#include <acdf/reader.h>

#include <cstdint>

namespace acdf::build {

/// p is the stored density, f the integrand, p* = g / (integral of g) the best density that is constant on texels,
/// which is f's own for one channel and nearest lookup (compress::Target); densities are in sr^-1.
struct Accuracy {
    /// Variance of one sample of the estimator f/p, over (integral of f)^2. Infinite with a support violation.
    double relative_variance = 0.0;
    /// What p* has: 0 but for several channels, which no density can fit at once, and for a filter, within texels.
    double least_variance = 0.0;
    double rms_pdf_error = 0.0;           ///< sqrt of the mean over the sphere of (p - p*)^2, sr^-1
    double kl_divergence = 0.0;           ///< integral of p* ln(p*/p), nats
    double max_weight = 0.0;              ///< largest f/p over its mean
    std::uint64_t support_violations = 0; ///< texels with f > 0 and p = 0
    std::uint64_t cells = 0;
    double total = 0.0; ///< integral of f
};

/// Compares an environment file with a target of the same grid (rows are theta and columns phi, or v and u). Throws
/// std::invalid_argument where the grids differ or the target has no energy.
Accuracy measure_environment(const File& file, const compress::Target& target);

} // namespace acdf::build
