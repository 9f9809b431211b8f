// What renderers do where a full-resolution CDF is too large: a CDF of a smaller picture.
#pragma once

#include "measure/samplers/full_cdf.h"
#include "measure/samplers/probe_grid.h"

#include <cstdint>

namespace acdf::measure {

/// A CDF (FullCdf) of columns x rows cells, each as bright as the mean over its texels: wherever there is light
/// there is pdf. Cells are equal but for rounding to whole texels; directions are uniform in a cell.
class DownsampledCdf {
public:
    /// Throws std::invalid_argument where there are no cells, more cells than texels along an axis, or no light.
    DownsampledCdf(const compress::Target& target, std::uint32_t columns, std::uint32_t rows);

    AcdfDirectionSample sample(double u0, double u1) const; ///< u0 (columns) and u1 (rows) in [0, 1)
    float pdf(const float direction[3]) const;              ///< sr^-1; 0 for directions that are NaN or not unit
    std::uint64_t bytes() const { return cdf_.bytes(); }

private:
    ProbeGrid grid_;
    std::uint32_t columns_, rows_;
    FullCdf cdf_;
};

} // namespace acdf::measure
