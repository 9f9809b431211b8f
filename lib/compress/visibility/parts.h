// The parts of the sphere that visibility cells weigh: boxes of tiles, and bright tiles.
#pragma once

#include <acdf/local.h>

#include <array>
#include <cstdint>
#include <vector>

namespace acdf::compress {

/// A local environment with tiles, cut where positions may see one side and not the other. Parts are numbered in
/// the order of a traversal; behind them come the bright tiles.
class VisibilityParts {
public:
    static constexpr std::uint32_t directions = 64; ///< of a part: where its light comes from

    /// Cuts at `columns` splits at most: those above the boxes of most light, and of most room for an edge.
    /// `local` must outlive this.
    VisibilityParts(const AcdfLocal& local, std::uint32_t bins, std::uint32_t columns);
    /// Cuts as often where most of `loss` lies, of which a part of `coarse` has so much. `coarse` may go.
    VisibilityParts(const VisibilityParts& coarse, const std::vector<double>& loss);

    const AcdfLocal& local() const { return local_; }
    std::size_t boxes() const { return box_count_; }
    std::size_t count() const { return box_count_ + local_.bright_tile_count; }
    /// One a split of tiles: its column, or ACDF_NO_COLUMN.
    const std::vector<std::uint16_t>& columns() const { return columns_; }
    std::uint32_t column_count() const { return static_cast<std::uint32_t>(cuts_.size()); }

    /// What of its light a normal gives to each part, by the stored rows; the sum is its irradiance over `total`.
    void weigh(const AcdfLocalPoint& point, float* out) const;
    /// A tile of a part: its middle, and what of the light it gives in the mean of all normals.
    struct Tile {
        std::array<float, 3> direction{};
        double solid_angle = 0.0, light = 0.0;
    };
    std::vector<Tile> tiles(std::size_t part) const;
    /// The part that a direction lies in; false where it is none.
    bool find(const float direction[3], std::uint32_t& part) const;
    const std::array<float, 3>& direction(std::size_t part, std::uint32_t index) const {
        return directions_[part * directions + index % directions];
    }
    /// For each column what falls into its two sides, of amounts for each part.
    std::vector<std::array<double, 2>> sides(const double* amount) const;

private:
    /// A split that is a column. A child is another cut, or `part` | number of a part.
    static constexpr std::uint32_t part = 0x80000000u;
    struct Cut {
        std::uint32_t split = 0;
        std::uint32_t child[2] = {};
    };
    std::vector<double> mean_tiles(std::uint32_t bins) const;
    std::vector<double> mass_below(const std::vector<double>& tiles) const;
    void cut(const std::vector<double>& worth, std::uint32_t columns);
    void choose(const std::vector<double>& worth, std::uint32_t columns);
    std::uint32_t number(std::uint32_t node);
    void aim();
    std::array<float, 3> place(std::uint32_t tile, double u0, double u1) const;

    const AcdfLocal& local_;
    std::vector<double> light_;    ///< of the tiles
    std::vector<AcdfRange> boxes_; ///< two a tile
    std::vector<std::vector<std::uint32_t>> tiles_of_part_;
    std::vector<std::uint32_t> part_of_tile_;
    std::size_t box_count_ = 0;
    std::vector<std::uint16_t> columns_;
    std::vector<Cut> cuts_; ///< in preorder
    std::vector<std::array<float, 3>> directions_;
};

} // namespace acdf::compress
