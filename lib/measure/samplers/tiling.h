// The strongest known baseline of a local environment map: tiles of the probe, weighted anew at each shading point.
#pragma once

#include "build/accuracy/texel_cosines.h"
#include "compress/target.h"
#include "measure/samplers/full_cdf.h"
#include "measure/samplers/probe_grid.h"
#include "measure/samplers/square_cone.h"

#include <acdf/sample.h>

#include <cstdint>
#include <vector>

namespace acdf::measure {

/// Tiling on the fly, the idea of LuxCore's visibility cache for environment lights: a probe L in columns x rows
/// tiles. For a normal, each tile gets the weight flux * (largest cosine that any of its directions has); a
/// tile is sampled by its weight, a direction by the tile's own full-resolution CDF. The largest cosine, never 0
/// where the tile reaches above the horizon, is what keeps the estimate unbiased. Tiles of the octahedral square
/// take that of a cone around them (SquareCone), which is larger.
///
/// Normals are unit. The target (one channel, nearest lookup) is referred to and must outlive the sampler.
class TilingOnTheFly {
public:
    /// Throws std::invalid_argument where there are more tiles than texels along an axis, or the target is black.
    TilingOnTheFly(const compress::Target& target, std::uint32_t columns, std::uint32_t rows);

    /// What is built for a shading point, of any number of samples.
    struct Point {
        std::vector<double> cumulative; ///< tiles + 1 sums of weights, from 0
        std::vector<double> across;     ///< for building
    };
    Point at(const float n[3]) const;
    /// The same into memory that is there already. `factors`: of the tiles' weights, one each; null: 1.
    void at(const float n[3], Point& point, const float* factors = nullptr) const;
    std::size_t tiles() const { return tables_.size(); }
    /// A direction of one tile by its light, pdf within the tile; u0 and u1 in [0, 1), rounded to float below 1.
    AcdfDirectionSample sample_tile(std::size_t tile, double u0, double u1) const;

    /// u0 and u1 in [0, 1). Where nothing is lit above the horizon, any tile's direction with pdf 0.
    AcdfDirectionSample sample(const Point& point, double u0, double u1) const;
    /// sr^-1; 0 for directions that are NaN or not unit.
    float pdf(const Point& point, const float direction[3]) const;
    /// Variance of one sample of f/p, f = L max(0, n . omega), over its mean squared: with b the bound of a tile's
    /// cosine, p = L b / W, W = the sum of flux b, so it is W (sum over tiles of int L cos^2 / b) / E^2 - 1; each
    /// texel's cosine at its centre. 0 where no light is above the horizon.
    double relative_variance(const float n[3]) const;
    /// The light in each tile, row by row.
    const std::vector<double>& flux() const { return flux_; }
    /// Of the tables; a point takes eight bytes a tile more.
    std::uint64_t bytes() const;

private:
    /// Where an axis is cut, and the cosine and sine of the angle there.
    struct Borders {
        std::vector<std::uint32_t> at; ///< tiles + 1 texels
        std::vector<double> cosine, sine;
        std::vector<std::uint16_t> tile; ///< of each texel
    };
    static Borders borders(std::uint32_t texels, std::uint32_t tiles, bool azimuth);
    /// `bound`: one a tile; `across`: room for two numbers a column of tiles.
    void largest_cosines(const float n[3], double* across, double* bound) const;
    const compress::Target& target_;
    ProbeGrid grid_;
    Borders columns_, rows_;
    std::vector<SquareCone> cones_; ///< one a tile of the octahedral square; none on lat-long grids
    std::vector<FullCdf> tables_;
    std::vector<double> flux_;
    build::TexelCosines cosines_;
};

} // namespace acdf::measure
