// The texels of a lat-long target that a surface sees, and their cosines: what the irradiance integrand
// L max(0, n . omega) is summed over.
#pragma once

#include "compress/target.h"

#include <acdf/sample.h>

#include <cmath>
#include <cstdint>
#include <vector>

namespace acdf::build {

/// Directions of the texels' centres: half of the columns' azimuths, and half of the rows' z, so that a row's
/// centre halves its solid angle. Using them in the place of all directions of a texel is wrong by O(1/rows^2).
class TexelCosines {
public:
    TexelCosines(std::uint32_t columns, std::uint32_t rows) : cosine_(columns), sine_(columns), z_(rows) {
        for (std::uint32_t c = 0; c < columns; ++c)
            acdf_sincospi(1.0 - (2.0 * c + 1.0) / columns, &sine_[c], &cosine_[c]);
        for (std::uint32_t r = 0; r < rows; ++r) z_[r] = 0.5 * (acdf_row_z(r, rows) + acdf_row_z(r + 1, rows));
    }

    /// Calls visit(column, cosine) for the texels of a row whose centre is above the horizon of unit normal n.
    template <class Visit>
    void for_each_above(const float n[3], std::uint32_t row, const Visit& visit) const {
        const double up = n[2] * z_[row], radius = std::sqrt((1.0 - z_[row]) * (1.0 + z_[row]));
        const double x = n[0] * radius, y = n[1] * radius;
        for (std::uint32_t c = 0; c < cosine_.size(); ++c) {
            const double cosine = up + x * cosine_[c] + y * sine_[c];
            if (cosine > 0.0) visit(c, cosine);
        }
    }

private:
    std::vector<double> cosine_, sine_; ///< of the columns' azimuths
    std::vector<double> z_;
};

} // namespace acdf::build
