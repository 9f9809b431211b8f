// What no table can beat where nothing is hidden: the light times the cosine on all texels of a probe, made anew
// for each point. To compare with.
#pragma once

#include "measure/samplers/light_sampler.h"
#include "measure/samplers/probe_grid.h"

#include <array>
#include <vector>

namespace acdf::measure {

/// What all points have in common.
class IdealRows {
public:
    /// `shares`: of as many samples for one of cos / pi the pdf is filled up for both together (water filling,
    /// docs/method.md); 0: it is to be used alone. Throws as ProbeGrid does.
    IdealRows(const compress::Target& target, double shares);

    std::uint64_t bytes() const { return radiance_.size() * (sizeof(float) + sizeof(double)); }

private:
    friend class IdealRow;

    ProbeGrid grid_;
    double shares_, reach_;       ///< no texel reaches further from its middle
    std::vector<float> radiance_; ///< of texels
    std::vector<double> measure_; ///< of rows
    std::vector<std::array<float, 3>> middle_;
};

/// At one point. Texels that the horizon cuts count with what of them may be above it, so that nothing is missed.
class IdealRow final : public PointSampler {
public:
    explicit IdealRow(const IdealRows& rows) : rows_(rows) {}

    void move_to(const ShadingPoint& point) override;
    AcdfDirectionSample sample(double u0, double u1) const override;
    float pdf(const float wi[3]) const override;

private:
    struct Texel {
        std::uint32_t index;
        double cosine, upto; ///< sum of the integrals of what is sampled, up to and with this one
    };
    double taken(const Texel& texel, double threshold) const;
    double fill();

    const IdealRows& rows_;
    std::vector<Texel> texels_;  ///< that are sampled
    std::vector<float> density_; ///< of all texels, sr^-1
};

} // namespace acdf::measure
