// An environment map of any layout as its renderer looks it up: which texels a lookup blends, and what it finds.
#pragma once

#include "build/probe/overlap.h"
#include "build/probe/projection.h"
#include "compress/target.h"

#include <array>
#include <cstdint>
#include <vector>

namespace acdf::build {

/// The texel that lies beside a map's own at (column, row), which may be one outside of the map, or of the cube's
/// face that holds the texel (`from_column`, `from_row`): lat-long maps wrap at the seam and stop at the poles,
/// octahedral ones go on across the sides, cubes on the next face; discs stop at the image. Where `map.repeats`,
/// lat-long maps and discs go on at the opposite border instead of stopping.
struct TexelPosition {
    int column = 0, row = 0;
};
TexelPosition texel_beside(const Map& map, int from_column, int from_row, int column, int row);

/// f over a part of a texel, summed over the channels that count: mean of each, mean of the sum of squares,
/// largest.
struct LookupMoments {
    std::array<double, 3> mean{};
    double square = 0.0, peak = 0.0;
};

/// The integrand that a renderer estimates, on the source's own texels: constant on each, or interpolated between
/// their centres.
class SourceLookup {
public:
    /// `rgb`: map.height x map.width x 3, finite, >= 0. Throws std::invalid_argument on what is not finite.
    SourceLookup(const Map& map, const float* rgb, const compress::TargetOptions& options);

    const Map& map() const { return map_; }
    std::uint32_t planes() const { return planes_; }
    /// Parts of a texel along each side within which f is one polynomial: one, or for an interpolated map two.
    int parts() const { return bilinear_ ? 2 : 1; }
    /// Means over a convex polygon, or at a single point, within part (column, row); both counted in parts over the
    /// whole map. Exact, but that the largest value is that of corners and middles of sides.
    LookupMoments moments(int column, int row, const Polygon& polygon) const;

private:
    double value(std::uint32_t plane, const TexelPosition& at) const {
        return values_[(std::size_t{plane} * static_cast<std::size_t>(map_.height) +
                        static_cast<std::size_t>(at.row)) *
                           static_cast<std::size_t>(map_.width) +
                       static_cast<std::size_t>(at.column)];
    }

    Map map_;
    bool bilinear_;
    std::uint32_t planes_;
    std::vector<float> values_; ///< planes x height x width
};

} // namespace acdf::build
