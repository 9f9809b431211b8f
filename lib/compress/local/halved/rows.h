// Rows of bins of normals whose mixtures have little variance at the normals between them.
#pragma once

#include "compress/local/halved/mixtures.h"
#include "compress/local/halved/moments.h"

#include <vector>

namespace acdf::compress {

/// One number a tile: what a row's random numbers are in proportion to. Empty where a bin is not stored.
using RowParts = std::vector<std::vector<float>>;

/// Of tiles whose light h is such that a tile with all samples has a second moment of the integral of h cos^2.
/// Where r is what a mixture gives to tiles and c the root of that integral, the relative variance is A S / E^2 -
/// 1, with A the sum of c^2 / r, S that of r and E that of c. Its derivatives by a row are a difference of two
/// positive sums; the square root of their ratio leads towards the minimum (as in Lee and Seung's factorizations).
class MixedRows {
public:
    /// BlockMoments, tiles and bins must outlive it.
    MixedRows(const BlockMoments& light, const std::vector<HalvedBox>& tiles, const NormalBins& bins);

    /// A part is positive wherever the bin sees light of the tile; their sum is what the bin's light costs.
    RowParts parts() const;
    /// Of each bin: how many times what their light costs mixtures that it serves sample, at most.
    std::vector<float> surplus(const RowParts& rows) const;
    /// What mixing adds to the relative variance of a sample, mean over mixtures, where rows give tiles so much
    /// each.
    double variance(const RowParts& rows) const;

private:
    struct Scales {
        float raise = 0.0f, lower = 0.0f; ///< of what a mixture adds to both sums
    };

    const float* cost(std::size_t mixture) const { return costs_.data() + mixture * tiles_.size(); }
    void mix(std::size_t mixture, const RowParts& rows, float* out) const;
    std::vector<Scales> scales(const RowParts& rows) const;
    void step(std::size_t bin, const RowParts& rows, const std::vector<Scales>& scales,
              const std::vector<float>& own, std::vector<float>& out) const;

    const std::vector<HalvedBox>& tiles_;
    const NormalBins& bins_;
    const Mixtures mixtures_;
    std::vector<float> costs_; ///< c: of each mixture, of each tile
    std::vector<float> whole_; ///< of each tile the root of the integral of h
    RowParts own_;             ///< of each bin c
};

} // namespace acdf::compress
