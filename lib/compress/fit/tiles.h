// Tiles of a probe: boxes that are small where much light comes from, so that the cosine to any normal hardly
// changes within one.
#pragma once

#include "compress/fit/partition.h"
#include "compress/target.h"

#include <array>
#include <cstdint>
#include <vector>

namespace acdf::compress {

/// A tree of splits in two, in preorder. A child is the index of a later split, or `tile` | number of a tile; tiles
/// are numbered in the order in which a traversal meets them.
struct TileTree {
    static constexpr std::uint32_t tile = 0x80000000u;
    static constexpr std::uint32_t most_depth = 32; ///< splits on a path
    struct Split {
        std::uint32_t axis = 0; ///< of the grid
        std::uint32_t position = 0;
        std::uint32_t child[2] = {};
    };
    std::vector<Split> splits;
    std::vector<Box> tiles;         ///< one more than splits
    std::uint32_t bright_tiles = 0; ///< tiles that are bright and small enough for a bright tile
};

/// Numbers on a coarse grid of the target's parameterization.
struct CoarseMap {
    static constexpr std::uint32_t columns = 128, rows = 64;
    std::vector<double> values = std::vector<double>(std::size_t{columns} * rows);

    /// At a position given as fractions of all columns and rows, in [0, 1).
    double at(double column, double row) const {
        return values[std::size_t(row * rows) * columns + std::size_t(column * columns)];
    }
};

/// What light is worth.
struct Worth {
    CoarseMap mean; ///< mean over the bins of cos / E: what a smaller cost of its cells saves
    /// Mean over the bins of sin^2 / (cos E), kept finite near the horizon: what a smaller spread of its tile
    /// saves.
    CoarseMap spread;
    /// Largest share of the samples of any normal that light at its horizon could sample by mistake, per unit of
    /// light.
    CoarseMap alarm;
    double band = 0.0; ///< sine below which light counts as at the horizon
};

/// Which tiles become bright tiles.
struct BrightTileRule {
    double alarm = 0.002; ///< those whose light could sample more by mistake
    double radius = 0.03; ///< radians; a bright tile is no larger
    bool few = false;     ///< bright tiles are not divided further; else they are the smaller the brighter they are
};

/// Divides a probe (rows theta, columns phi, or v and u) into at most `count` tiles. Each split is the one that
/// lowers most the sum over tiles of the light's angular variance, ∫ w L |omega - mean|^2 with w = worth.spread: to
/// first order, what the cosine to a normal adds to the variance within a tile. Tiles of bright light that are too
/// large for a bright tile come first.
TileTree divide_tiles(const Target& target, const Worth& worth, std::uint32_t count,
                      const BrightTileRule& rule = {});

/// The middle of a box in phi and z, or in u and v, and so of its solid angle.
std::array<double, 3> centre(const Target& target, const Box& box);

/// The largest cosine between a unit vector and any direction of a box; on the octahedral square a bound near it.
double largest_cosine(const Target& target, const Box& box, const std::array<double, 3>& n);

/// The largest distance of any point of a box on the unit sphere from its centre; on the octahedral square a bound.
double radius(const Target& target, const Box& box);

} // namespace acdf::compress
