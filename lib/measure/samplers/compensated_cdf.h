// A CDF that leaves to other samplers what they do well.
#pragma once

#include "measure/samplers/full_cdf.h"
#include "measure/samplers/probe_grid.h"

namespace acdf::measure {

/// MIS compensation (Karlik, Sik, Vevoda, Skrivan, Krivanek, "MIS Compensation: Optimizing Sampling Techniques in
/// Multiple Importance Sampling", SIGGRAPH Asia 2019), one for all normals: the full-resolution CDF of max(0, L - s
/// mean L), the mean over the sphere; uniform where nothing exceeds it. s = 1 is what pbrt-v4 subtracts. Other
/// samplers take care of what is subtracted: it has no support there, and is biased on its own.
class CompensatedCdf {
public:
    /// Throws std::invalid_argument where the target is no probe or black.
    explicit CompensatedCdf(const compress::Target& target, double s = 1.0);

    AcdfDirectionSample sample(double u0, double u1) const; ///< u0 (columns) and u1 (rows) in [0, 1)
    float pdf(const float direction[3]) const;              ///< sr^-1; 0 for directions that are NaN or not unit
    std::uint64_t bytes() const { return cdf_.bytes(); }

private:
    ProbeGrid grid_;
    FullCdf cdf_;
};

} // namespace acdf::measure
