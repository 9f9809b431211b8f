// The light of the tiles of a local environment map, as normals see it: what rows of probabilities are made from.
#pragma once

#include "compress/fit/tiles.h"
#include "compress/local/horizon.h"
#include "compress/local/light.h"
#include "compress/local/tile_insides.h"

#include <acdf/layout.h>

#include <array>
#include <cstddef>
#include <vector>

namespace acdf::compress {

/// What a normal sees of each tile.
struct TileView {
    std::vector<double> cost;   ///< 0: a bright tile, dark, or hidden
    std::vector<double> hidden; ///< of the samples within the tile: the share below the horizon
};

/// Of each tile but the bright tiles, its light as points, weighted so that the sum of amount . cos^2 is the square
/// of the cost of the tile for a normal. `target` and `tiles` must outlive it.
class TileLight {
public:
    TileLight(const Target& target, const TileTree& tiles, const TileInsides& insides,
              const std::vector<AcdfBrightTile>& bright_tiles);

    std::size_t size() const { return tile_.size(); }
    /// The cost of all light of a tile, whatever the cosine; 0: a bright tile, or dark.
    double whole(std::size_t tile) const { return tile_[tile].cost; }
    void look(const Direction& normal, TileView& out) const;
    /// From up to `views_at_once` normals at once: in little more time than from one, where they are close.
    static constexpr std::size_t views_at_once = 4;
    void look(const Direction* normals, std::size_t count, TileView* out) const;
    /// The cost of each tile for a normal: positive wherever light in it can be seen, however little.
    std::vector<double> costs(const Direction& normal) const;
    /// The least that each tile's part of the irradiance may be taken for, so that no weight is above `max_weight`
    /// times the mean: p in a cell is the tile's part, `parts`, times that of the cell in it.
    std::vector<double> least(const Direction& normal, const std::vector<double>& parts, double max_weight) const;

private:
    struct Tile {
        Direction centre{};
        double reach = 0.0;             ///< of any direction in it, from its centre
        double cost = 0.0;              ///< of all its light, whatever the cosine; 0: a bright tile, or dark
        double amount = 0.0;            ///< of all its points
        std::array<double, 6> moment{}; ///< sums over points of amount times xx, yy, zz, 2 xy, 2 yz, 2 zx
        std::vector<LightPoint> points;
        std::vector<LitCell> lit; ///< cells that have light
        double heaviest = 0.0;    ///< of their weights
    };

    void fill(const TileInsides& insides, std::size_t tile);
    /// Of tiles that the horizon cuts, for each normal the square of the cost, and what of the light is hidden.
    struct AcrossHorizon {
        double square[views_at_once] = {}, hidden[views_at_once] = {};
    };
    static AcrossHorizon across_horizon(const Tile& tile, const double (&normals)[3][views_at_once]);
    /// Whether any cell with light in it reaches above the horizon.
    bool seen(std::size_t tile, const Direction& normal) const;

    const Target& target_;
    const DividedGrid divided_;
    const TileTree& tiles_;
    std::vector<Tile> tile_;
};

} // namespace acdf::compress
