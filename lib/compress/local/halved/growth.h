// Where the tree of a local environment map divides: its top by what normals together pay for it, what is below by
// the light alone, as much as that is worth to them.
#pragma once

#include "compress/halvings/growth.h"
#include "compress/halvings/sums.h"
#include "compress/local/halved/moments.h"
#include "compress/local/normals.h"

#include <atomic>
#include <cstdint>
#include <memory>
#include <vector>

namespace acdf::compress {

/// Normals that stand for all, and what their relative noise counts.
struct SomeNormals {
    Normals normals;
    std::vector<double> weights;
};

/// At most 66: those of bins that are stored, or of coarser ones around them.
SomeNormals few_normals(const NormalBins& bins);

/// Normals with the light h2 whose cosines count for them.
struct LitNormals {
    const BlockMoments* light;
    SomeNormals normals;
};

/// The cost of a node as a tile, where each normal has the share of it that suits it: the root of the integral of h
/// times that of h2 cos^2 above the horizon, summed over normals by their weights. Where both are the light of the
/// probe, the integral of it times the cosine is what it comes to in small nodes.
class TopCosts final : public HalvedCosts {
public:
    TopCosts(const Blocks& blocks, const BlockMoments& light, std::vector<LitNormals> normals);

    float cost(HalvedBox box) const override;
    double least_square() const override { return least_ * least_; }

private:
    double root_sum(HalvedBox box) const;

    const Blocks& blocks_;
    const BlockMoments& light_;
    std::vector<LitNormals> normals_;
    double least_ = 0.0;
    mutable std::vector<std::atomic<float>> known_; ///< of each box; below 0: not yet
};

/// Divides weights by what the light of the probe costs a normal at least, so that they add up to 1 times that.
void weigh_by_light(const Blocks& blocks, const BlockMoments& light, SomeNormals& normals);

/// What light of a direction is worth: the mean over normals of its cosine over what the normal's light costs. Some
/// even where no normal sees it, for points without a normal.
std::vector<float> worth_of_blocks(const Blocks& blocks, const SomeNormals& normals);

/// The block that the middle of each texel of an axis lies in.
std::vector<std::uint32_t> blocks_of_texels(const std::vector<double>& borders);

/// Light times its worth, and its squares.
class SharedLight {
public:
    /// `unit`: what light is multiplied with.
    SharedLight(const Blocks& blocks, std::vector<float> worth, double unit);

    const HalvedSums& costs() const { return *costs_; }
    float worth(HalvedBox box) const { return worth_[blocks_.index(blocks_.block_of(box))]; }
    /// Root of a box's measure times the integral of the square of light.
    double alone(HalvedBox box) const { return costs_->alone(box) / (double{worth(box)} * cost_unit()); }
    /// What costs are multiplied with, beside those of the top.
    double cost_unit() const { return costs_->unit(); }

private:
    const Blocks& blocks_;
    std::vector<float> worth_; ///< of blocks
    std::vector<float> values_;
    std::unique_ptr<HalvedSums> costs_;
};

} // namespace acdf::compress
