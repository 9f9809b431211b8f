// Jittered sampling of a stratified map: what Lawrence et al. 2005, §7.1, compare with.
#pragma once

#include "measure/samplers/estimator.h"
#include "measure/samplers/probe_grid.h"

#include <cstdint>
#include <vector>

namespace acdf::measure {

/// How directions are sampled in a stratum.
enum class Jitter {
    solid_angle, ///< uniformly, as published
    radiance, ///< by radiance: what a stratum's light varies then makes no noise, and nothing is biased, as it is
              ///< where the published method integrates that light beforehand
};

/// The strata of stratify() with the tables to sample from each.
class StratifiedMap {
public:
    StratifiedMap(const compress::Target& target, std::uint32_t strata, Jitter jitter = Jitter::solid_angle);

    std::size_t strata() const { return first_.size() - 1; }
    /// One direction of a stratum; pdf is that within it, 0 where it has no light to sample by. All u in [0, 1).
    AcdfDirectionSample sample(std::size_t stratum, double choice, double u0, double u1) const;
    std::uint64_t bytes() const;

private:
    struct Texel {
        std::uint32_t index;
        float pdf; ///< sr^-1, within the stratum
    };
    ProbeGrid grid_;
    std::vector<std::size_t> first_; ///< of each stratum in `texels_`; strata + 1
    std::vector<Texel> texels_;      ///< stratum by stratum
    std::vector<double> cumulative_; ///< of `texels_`, from 0 to 1 in each stratum, this texel included
};

/// The sum over strata of f/p, one direction each. No pdf of a single sample is defined (a sample's stratum is
/// its number), so that it does not combine with others.
class StratifiedEstimator : public Estimator {
public:
    explicit StratifiedEstimator(const StratifiedMap& map) : map_(map) {}
    std::unique_ptr<PointEstimator> point_estimator() const override;
    std::uint64_t bytes() const override { return map_.bytes(); }

private:
    const StratifiedMap& map_;
};

} // namespace acdf::measure
