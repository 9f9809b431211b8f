// How far the pdfs of a file are from its source: exact, by summation over the source, of the pdfs that the file
// stores.
#pragma once

#include <cstdint>

namespace acdf::builder {

/// Of the stored pdf, after quantization, by summation over every texel: no samples, no noise. The function f is
/// the target, p the pdf, p* the best pdf that is constant on texels; pdfs in sr^-1.
struct EnvironmentAccuracy {
    /// Variance of one sample of the estimator f/p, over (integral of f)^2. Infinite with a support violation.
    double relative_variance = 0.0;
    /// What p* has: 0 but for several channels, which no pdf can fit at once, and within texels for a filter,
    /// and where the map was resampled to another grid.
    double least_variance = 0.0;
    double rms_pdf_error = 0.0;           ///< sqrt of the mean over the sphere of (p - p*)^2, sr^-1
    double kl_divergence = 0.0;           ///< integral of p* ln(p*/p), nats
    double max_weight = 0.0;              ///< largest f/p over its mean
    std::uint64_t support_violations = 0; ///< texels with f > 0 and p = 0
    std::uint64_t cells = 0;
    double total = 0.0; ///< integral of f.
    /// The file has an MIS partner: relative_variance, max_weight and support_violations are those of estimates of
    /// irradiance from both together, mean over normals. The variance is that of N samples in the fit's shares,
    /// times N. Then least_variance, rms_pdf_error and kl_divergence are 0.
    bool combined = false;
};

/// Of one of several maps, at its coordinates, as in EnvironmentAccuracy. Near the sun by summation over 64 points
/// of each texel.
struct MapAccuracy {
    double relative_variance = 0.0;
    double max_weight = 0.0;
    std::uint64_t support_violations = 0;
    double total = 0.0; ///< of the map
};

/// Over normals that see any light, each as important as any other; f is the light times the cosine.
struct LocalAccuracy {
    double relative_variance = 0.0; ///< mean, of one sample of f/p; infinite with a violation
    double median = 0.0, worst = 0.0;
    double relative_variance_full_cdf = 0.0; ///< mean of what the map's own full-resolution CDF has
    double share_above_horizon = 0.0, least_share_above_horizon = 0.0; ///< of samples
    double share_above_horizon_full_cdf = 0.0, least_share_above_horizon_full_cdf = 0.0;
    double max_weight = 0.0;              ///< largest f/p over its mean
    std::uint64_t support_violations = 0; ///< texels with f > 0 and p = 0
    std::uint32_t lit_normals = 0;
    /// The file has an MIS partner: variances, weights and violations are those of both together. The variance is
    /// that of N samples in the fit's shares, times N. That of the full CDF is the same, with the CDF in place of
    /// the file.
    bool combined = false;
};

/// Over random views, cos(theta_o) uniform in [0.1, 1], each as important as any other; f is rho times the cosine.
struct BrdfAccuracy {
    double relative_variance = 0.0; ///< mean, of one sample of f/p; infinite with a violation
    double median = 0.0, worst = 0.0;
    double rms_pdf_error = 0.0;                            ///< over views and the hemisphere, sr^-1
    double kl_divergence = 0.0, share_above_horizon = 0.0; ///< means
    double max_weight = 0.0;                               ///< largest f/p over its mean
    std::uint64_t support_violations = 0, cells = 0;
    std::uint32_t views = 0; ///< of those that reflect anything
};

/// Over the bins that have energy, each as important as any other.
struct TableAccuracy {
    bool combined = false;          ///< as in EnvironmentAccuracy; errors of the pdf are then 0
    double relative_variance = 0.0; ///< mean, of one sample of f/p; infinite with a violation
    double median = 0.0, worst = 0.0;
    std::uint32_t worst_bin = 0;
    double rms_pdf_error = 0.0; ///< over bins and volume; a bin of uniform pdf has 1 everywhere
    double kl_divergence = 0.0; ///< mean, nats
    double max_weight = 0.0;    ///< largest f/p over its mean
    std::uint64_t support_violations = 0, cells = 0;
    std::uint32_t lit_bins = 0;
};

} // namespace acdf::builder
