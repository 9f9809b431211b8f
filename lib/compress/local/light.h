// The light of a probe as a few ten thousand points, and what it is worth to the normals that it shines on.
#pragma once

#include "compress/fit/octahedral_boxes.h"
#include "compress/fit/tiles.h"
#include "compress/local/normals.h"

#include <acdf/sample.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

namespace acdf::compress {

using Direction = std::array<double, 3>;

inline double dot(const Direction& a, const Direction& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }

/// Light from so small a solid angle that it has one cosine.
struct LightPoint {
    Direction direction{};
    double amount = 0.0;
    double measure = 0.0; ///< the solid angle that it comes from, where that is known
    double radius = 0.0;  ///< of any direction in it, from the middle, where that is known
};

/// Radians across which light is taken to have one cosine.
constexpr double kPointStep = 0.02;
constexpr double kTexelStep = 0.05; ///< and across which a texel is, which blocks do not divide

double solid_angle(const Target& target, const Box& box);
/// The height and width of a texel in the middle of a box.
std::array<double, 2> texel_radians(const Target& target, const Box& box);

/// Calls `visit(block, share)` for blocks of a box of at most about `step` radians, with their share of its solid
/// angle.
template <class Visit>
void for_each_block(const Target& target, const Box& box, double step, const Visit& visit) {
    const auto count = [&](std::size_t axis, double radians) {
        const double blocks = std::ceil(radians / step);
        return static_cast<std::uint32_t>(std::clamp(blocks, 1.0, double(box.length(axis))));
    };
    // The side of the octahedral square is as long as that of one of 4 pi.
    const bool octahedral = is_octahedral(target);
    const double side = 2.0 * std::sqrt(ACDF_PI);
    const std::uint32_t rows = count(0, (octahedral ? side : ACDF_PI) * box.length(0) / target.rows);
    const double whole = solid_angle(target, box);
    for (std::uint32_t i = 0; i < rows; ++i) {
        Box band = box;
        band.begin[0] = box.begin[0] + std::uint32_t(std::uint64_t{box.length(0)} * i / rows);
        band.end[0] = box.begin[0] + std::uint32_t(std::uint64_t{box.length(0)} * (i + 1) / rows);
        const double z = centre(target, band)[2];
        const double around = octahedral ? side : 2.0 * ACDF_PI * std::sqrt(1.0 - z * z);
        const std::uint32_t columns = count(1, around * box.length(1) / target.columns);
        for (std::uint32_t k = 0; k < columns; ++k) {
            Box block = band;
            block.begin[1] = box.begin[1] + std::uint32_t(std::uint64_t{box.length(1)} * k / columns);
            block.end[1] = box.begin[1] + std::uint32_t(std::uint64_t{box.length(1)} * (k + 1) / columns);
            visit(block, solid_angle(target, block) / whole);
        }
    }
}

/// The direction at a place of the grid, in texels.
Direction direction_at(const Target& target, double row, double column);

/// The grid of a target, without values, whose texels are no larger than kTexelStep: those of coarse maps are
/// divided, for a horizon that cuts one leaves light above it.
struct DividedGrid {
    explicit DividedGrid(const Target& target);

    Target grid;
    std::array<std::uint32_t, 2> parts; ///< rows and columns of each texel

    /// Calls `visit(direction, share)` for blocks of a box of the target that have one cosine, with their share of
    /// its solid angle.
    template <class Visit>
    void for_each_point(Box box, const Visit& visit) const {
        for (std::size_t axis = 0; axis < 2; ++axis) box.begin[axis] *= parts[axis], box.end[axis] *= parts[axis];
        for_each_block(grid, box, kPointStep,
                       [&](const Box& block, double share) { visit(centre(grid, block), share); });
    }
};

/// The integrals of g over blocks of about a degree.
std::vector<LightPoint> light_points(const Target& target);

/// For each bin the integral of the light above its horizon times the cosine.
std::vector<double> irradiance(const std::vector<LightPoint>& points, const NormalBins& bins);

/// On a coarse grid of the target's parameterization.
Worth worth(const Target& target, const NormalBins& bins, const std::vector<double>& irradiance);

/// What the light of a probe is to bins, however large a file for them becomes.
struct BinLight {
    BinLight(const Target& target, const NormalBins& bins);

    std::vector<LightPoint> points;
    std::vector<double> irradiance; ///< of each bin
    Worth worth;
};

} // namespace acdf::compress
