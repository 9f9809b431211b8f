// What a renderer finds in a map in a direction: the texel there, or a blend of the four whose centres surround it.
#pragma once

#include "compress/target.h"

#include <acdf/grid.h>

#include <array>
#include <cstddef>
#include <cstdint>

namespace acdf::measure {

/// Of a lat-long or octahedral map. Beyond the first and the last row of a lat-long one a blend finds that row
/// again, or where `repeats` the one at the other end; across a side of an octahedral square it goes on where the
/// direction does.
class MapLookup {
public:
    struct Blend {
        std::array<std::size_t, 4> texel{}; ///< row-major
        std::array<double, 4> weight{};     ///< sum 1
    };

    MapLookup(std::uint32_t columns, std::uint32_t rows, AcdfParameterization parameterization, AcdfFilter filter,
              bool repeats = false)
        : grid_{columns, rows, static_cast<std::uint32_t>(parameterization)}, filter_(filter), repeats_(repeats) {}

    /// False for directions that are NaN or not unit. Of a nearest lookup the first texel has all the weight.
    bool find(const float direction[3], Blend& out) const;

private:
    std::size_t beside(std::int64_t column, std::int64_t row) const;

    AcdfGrid grid_;
    AcdfFilter filter_;
    bool repeats_;
};

/// The light of a map of one channel, which is referred to.
class MapLight {
public:
    /// Constant on the target's texels.
    explicit MapLight(const compress::Target& texels) : MapLight(texels, ACDF_FILTER_NEAREST, false) {}
    /// `texels`: of nearest lookup, so that its values are those that are blended.
    MapLight(const compress::Target& texels, AcdfFilter filter, bool repeats)
        : lookup_(texels.columns, texels.rows, texels.parameterization, filter, repeats), values_(&texels.values) {}

    double radiance(const float direction[3]) const {
        MapLookup::Blend blend;
        if (!lookup_.find(direction, blend)) return 0.0;
        double sum = 0.0;
        for (std::size_t k = 0; k < 4; ++k) sum += blend.weight[k] * double{(*values_)[blend.texel[k]]};
        return sum;
    }

private:
    MapLookup lookup_;
    const std::vector<float>* values_;
};

} // namespace acdf::measure
