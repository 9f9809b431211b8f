// Warping through a quadtree of fluxes, as Mitsuba offers it.
#pragma once

#include "measure/samplers/probe_grid.h"

#include <cstdint>
#include <vector>

namespace acdf::measure {

/// Hierarchical warping (Clarberg, Jarosz, Akenine-Moller, Jensen, "Wavelet Importance Sampling", SIGGRAPH 2005):
/// from one texel that is the whole probe, each level chooses one of four: the upper or lower two by u1, then the
/// left or right one by u0, with the numbers stretched to [0, 1) again. Where a level has an odd number of columns
/// or rows, those that lack are black. The four of a choice lie side by side in memory.
class HierarchicalWarp {
public:
    /// Throws std::invalid_argument where the target is no probe or black.
    explicit HierarchicalWarp(const compress::Target& target);

    AcdfDirectionSample sample(double u0, double u1) const; ///< u0 (columns) and u1 (rows) in [0, 1)
    float pdf(const float direction[3]) const;              ///< sr^-1; 0 for directions that are NaN or not unit
    std::uint64_t bytes() const;

private:
    struct Quad {
        float share[4] = {0.0f, 0.0f, 0.0f,
                          0.0f}; ///< of the flux: upper left, upper right, lower left, lower right
    };
    struct Level {
        std::uint32_t columns = 0;
        std::vector<Quad> quads;
    };

    ProbeGrid grid_;
    std::vector<Level> levels_;       ///< the texels' first
    std::vector<double> solid_angle_; ///< of a texel of each row
};

} // namespace acdf::measure
