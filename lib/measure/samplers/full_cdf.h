// The baseline: a full-resolution table of marginal and conditional CDFs.
#pragma once

#include "compress/target.h"

#include <cstdint>
#include <vector>

namespace acdf::measure {

/// Samples a target by inverting one marginal CDF over rows, then the CDF of that row over columns, all at
/// full resolution and in float32 as renderers store them (Pharr and Humphreys, Physically Based Rendering,
/// 2004, §16). Memory: about eight bytes a texel.
class FullCdf {
public:
    explicit FullCdf(const compress::Target& target);

    /// Continuous grid positions and the pdf over the target's measure there (sr^-1 for a probe).
    struct Draw {
        double column = 0.0, row = 0.0;
        double pdf = 0.0;
    };
    /// u0 (columns) and u1 (rows) in [0, 1).
    Draw sample(float u0, float u1) const;
    /// Pdf on a grid square.
    double pdf(std::uint32_t column, std::uint32_t row) const;
    /// Size of the tables.
    std::uint64_t bytes() const;

private:
    std::uint32_t columns_, rows_;
    std::vector<float> function_;     ///< rows x columns: f
    std::vector<float> row_integral_; ///< rows: integral of f over columns
    std::vector<float> conditional_;  ///< rows x (columns + 1): CDFs from 0 to 1
    std::vector<float> marginal_;     ///< rows + 1: CDF
    double total_ = 0.0;
};

/// Relative variance of one sample of f/p sampled by a FullCdf of the target, by exact summation over texels.
double full_cdf_relative_variance(const compress::Target& target);

} // namespace acdf::measure
