// The texels of a target that a surface sees, and their cosines: what the irradiance integrand
// L max(0, n . omega) is summed over.
#pragma once

#include "compress/target.h"

#include <acdf/sample.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <vector>

namespace acdf::build {

/// Directions of the texels' centres: half of the columns' azimuths, and half of the rows' z, so that a row's
/// centre halves its solid angle; or the middle in u and v. Using them in the place of all directions of a texel is
/// wrong by O(1/rows^2).
class TexelCosines {
public:
    explicit TexelCosines(const compress::Target& target) : columns_(target.columns) {
        if (target.parameterization == ACDF_PARAM_OCTAHEDRAL) fill_square(target.rows);
        else fill_latlong(target.rows);
    }

    /// Calls visit(column, cosine) for the texels of a row whose centre is above the horizon of unit normal n.
    template <class Visit>
    void for_each_above(const float n[3], std::uint32_t row, const Visit& visit) const {
        const Row cosines = of_row(n, row);
        for (std::uint32_t c = 0; c < columns_; ++c) {
            const double cosine = cosines.at(c);
            if (cosine > 0.0) visit(c, cosine); // called once in the code, so that it is inlined
        }
    }

    /// The same cosines of a whole row, 0 below the horizon.
    void write_row(const float n[3], std::uint32_t row, double* __restrict out) const {
        const Row cosines = of_row(n, row);
        for (std::uint32_t c = 0; c < columns_; ++c) out[c] = std::max(0.0, cosines.at(c));
    }

private:
    /// Cosines of a row: of directions, or of what a row's and a column's give together.
    struct Row {
        const std::array<float, 3>* directions; ///< null: of a lat-long map
        const float* n;
        const double *cosine, *sine;
        double up, x, y;

        double at(std::uint32_t c) const {
            if (!directions) return up + x * cosine[c] + y * sine[c];
            const std::array<float, 3>& d = directions[c];
            return double{n[0]} * d[0] + double{n[1]} * d[1] + double{n[2]} * d[2];
        }
    };
    Row of_row(const float n[3], std::uint32_t row) const {
        const std::array<float, 3>* const d =
            directions_.empty() ? nullptr : directions_.data() + std::size_t{row} * columns_;
        const double z = d ? 0.0 : z_[row], radius = std::sqrt((1.0 - z) * (1.0 + z));
        return {d, n, cosine_.data(), sine_.data(), n[2] * z, n[0] * radius, n[1] * radius};
    }
    void fill_latlong(std::uint32_t rows) {
        cosine_.resize(columns_);
        sine_.resize(columns_);
        z_.resize(rows);
        for (std::uint32_t c = 0; c < columns_; ++c)
            acdf_sincospi(1.0 - (2.0 * c + 1.0) / columns_, &sine_[c], &cosine_[c]);
        for (std::uint32_t r = 0; r < rows; ++r) z_[r] = 0.5 * (acdf_row_z(r, rows) + acdf_row_z(r + 1, rows));
    }
    void fill_square(std::uint32_t rows) {
        for (std::uint32_t r = 0; r < rows; ++r)
            for (std::uint32_t c = 0; c < columns_; ++c) {
                double d[3];
                acdf_octahedral_direction((c + 0.5) / columns_, (r + 0.5) / rows, d);
                directions_.push_back(
                    {static_cast<float>(d[0]), static_cast<float>(d[1]), static_cast<float>(d[2])});
            }
    }

    std::uint32_t columns_;
    std::vector<double> cosine_, sine_; ///< of the columns' azimuths
    std::vector<double> z_;
    std::vector<std::array<float, 3>> directions_; ///< of the texels of a square
};

} // namespace acdf::build
