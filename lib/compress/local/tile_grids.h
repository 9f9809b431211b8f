// Grids in the tiles of a local environment map, as its fast shape has them (format/SPEC.md, section 10.6).
#pragma once

#include "compress/local/tile_insides.h"
#include "compress/target.h"

#include <array>
#include <cstdint>
#include <vector>

namespace acdf::compress {

constexpr std::uint32_t kMostGridCells = ACDF_FAST_CELLS; ///< along an axis
constexpr std::uint64_t kGridSteps = 255;                 ///< that make up a probability of 1

/// The grid of a tile. Axis 0 are columns, axis 1 the lines.
struct TileGrid {
    std::array<std::uint32_t, 2> shift{}; ///< a cell has 2^shift texels
    std::array<std::uint32_t, 2> count{1, 1};
    std::vector<double> cost;         ///< sqrt(measure . integral of g^2) of each cell, line by line
    std::vector<std::uint64_t> lines; ///< steps of each line: at least one where there is light
    std::vector<std::uint64_t> cells; ///< steps of each cell in its line: at least one where there is light
    /// sqrt(integral of g^2 / p) with the pdf p that the steps stand for.
    double whole = 0.0;

    /// The probability of a cell within the tile.
    double probability(std::size_t line, std::size_t column) const {
        return double(lines[line] * cells[line * count[0] + column]) / double(kGridSteps * kGridSteps);
    }
    std::uint64_t bytes() const { return 2 + count[1] + std::uint64_t{count[1]} * count[0]; }
};

/// The best steps for cells of those costs; `cost` has count[0] times count[1] numbers.
TileGrid stepped_grid(std::array<std::uint32_t, 2> shift, std::array<std::uint32_t, 2> count,
                      std::vector<double> cost);

/// A grid for each tile, as fine as pays.
class TileGrids : public TileInsides {
public:
    /// `worth`: one a tile, what its light is worth. `target` and `tiles` must outlive it. The same for any number
    /// of threads.
    TileGrids(const Target& target, const std::vector<Box>& tiles, std::vector<double> worth);

    /// Takes those grids of at most `bytes` in all, and nearly as many where more still gain, for which the sum
    /// over tiles of worth times cost is least; but for the least that there must be.
    void choose(std::uint64_t bytes);

    double tile_cost(std::size_t tile) const override { return grids_[tile].whole / total_; }
    std::vector<LitCell> lit_cells(std::size_t tile) const override;
    const TileGrid& grid(std::size_t tile) const { return grids_[tile]; }
    /// Chunk GRID, and the offset in it of each tile's.
    std::vector<std::uint8_t> stored(std::vector<std::uint32_t>& offsets) const;

private:
    struct Choice {
        std::array<std::uint32_t, 2> shift;
        double cost;
        std::uint64_t bytes;
    };
    Box box_of(std::size_t tile, const TileGrid& grid, const std::array<std::uint32_t, 2>& begin,
               const std::array<std::uint32_t, 2>& end) const;
    void look_at(std::size_t tile);
    std::uint64_t choose_at(double price);

    const Target& target_;
    const std::vector<Box>& tiles_;
    std::vector<double> worth_;
    double total_; ///< integral of the target, to which costs are normalised
    std::vector<std::vector<Choice>> choices_;
    std::vector<std::size_t> chosen_;
    std::vector<TileGrid> grids_;
};

} // namespace acdf::compress
