// The texels of a probe, as samplers of texels see them.
#pragma once

#include "compress/target.h"
#include "measure/samplers/full_cdf.h"

#include <acdf/sample.h>

#include <cstdint>
#include <stdexcept>

namespace acdf::measure {

class ProbeGrid {
public:
    /// Throws std::invalid_argument where the target is no probe (compress::of_texels), or black.
    explicit ProbeGrid(const compress::Target& target)
        : grid_{target.columns, target.rows, static_cast<std::uint32_t>(target.parameterization)},
          flux_(compress::integral(target)) {
        if (!target.peaks.empty() || target.values.empty())
            throw std::invalid_argument("a sampler of texels needs a probe on its own grid");
        if (!(flux_ > 0.0)) throw std::invalid_argument("a black probe has nothing to sample");
    }

    std::uint32_t columns() const { return grid_.columns; }
    std::uint32_t rows() const { return grid_.rows; }
    std::size_t texels() const { return std::size_t{grid_.columns} * grid_.rows; }
    /// Integral of the radiance over the sphere.
    double flux() const { return flux_; }

    /// A direction in a box of texels, column and row ranges in `range`, at fractions u of it in azimuth and z or
    /// in u and v.
    AcdfDirectionSample place(const AcdfRange range[2], double u0, double u1, double pdf) const {
        const double u[2] = {u0, u1};
        AcdfDirectionSample out = acdf_grid_position(&grid_, range, u, 1.0);
        out.pdf = static_cast<float>(pdf);
        return out;
    }
    AcdfDirectionSample place(std::uint32_t column, std::uint32_t row, double u0, double u1, double pdf) const {
        const AcdfRange range[2] = {{column, column + 1}, {row, row + 1}};
        return place(range, u0, u1, pdf);
    }
    AcdfDirectionSample place(const FullCdf::Draw& draw) const {
        const auto column = static_cast<std::uint32_t>(draw.column), row = static_cast<std::uint32_t>(draw.row);
        return place(column, row, draw.column - column, draw.row - row, draw.pdf);
    }
    /// The texel (column, row) of a direction; false for those that are NaN or not unit.
    bool find(const float direction[3], std::uint32_t texel[2]) const {
        double position[2];
        return acdf_grid_square(&grid_, direction, texel, position) != 0;
    }

private:
    AcdfGrid grid_;
    double flux_;
};

} // namespace acdf::measure
