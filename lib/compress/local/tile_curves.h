// The curves within the tiles of a probe, and the tree of the whole environment that they are parts of.
#pragma once

#include "compress/fit/prune.h"
#include "compress/fit/tiles.h"
#include "compress/local/tile_insides.h"

#include <cstdint>
#include <limits>
#include <memory>
#include <vector>

namespace acdf::compress {

/// Calls `visit(part)` for each cell below part i of a partition that is pruned.
template <class Visit>
void for_each_cell(const std::vector<Part>& parts, const Pruned& pruned, const Visit& visit, std::size_t i = 0) {
    if (!pruned.divided[i]) return visit(parts[i]);
    for (std::uint32_t k = 0; k < parts[i].children; ++k)
        for_each_cell(parts, pruned, visit, parts[i].first_child + k);
}

/// A partition of each tile, grown once and pruned at any price.
class TileCurves {
public:
    /// `worth`: one a tile, what its light is worth; tiles of none stay whole. Cells whose weight() is above
    /// `heaviest` are divided at any price.
    TileCurves(const Target& target, const std::vector<Box>& tiles, std::vector<double> worth,
               double heaviest = std::numeric_limits<double>::infinity());

    /// The integral of the target, to which all costs are normalised.
    double total() const { return total_; }
    const Partition& partition(std::size_t tile) const { return *partitions_[tile]; }
    const PruneNodes& nodes(std::size_t tile) const { return nodes_[tile]; }
    /// Grows the partitions until divisions that pay at `price` a byte are in them.
    void refine(double price);
    Pruned pruned(std::size_t tile, double price) const;
    /// The sum of the shares of the cells of a tile.
    double cost(std::size_t tile, const Pruned& pruned) const;

private:
    void look_at(std::size_t tile);

    std::vector<double> worth_;
    double heaviest_, total_ = 0.0;
    std::vector<std::unique_ptr<Partition>> partitions_;
    std::vector<PruneNodes> nodes_; ///< of the partitions: they are pruned at many prices
};

/// Whether the curves in tiles are parts of the tree of the whole environment, too, or that has curves of its own.
enum class WholeTree { of_tiles, own };

/// The curves in tiles. WholeTree::of_tiles: the tree of a whole environment, whose splits between tiles are curves
/// of two segments above them.
class TileCascade : public TileInsides {
public:
    /// Prunes at `price` a byte. `tiles` and `curves` must outlive it.
    TileCascade(const TileTree& tiles, const TileCurves& curves, double price, WholeTree whole);

    Cascade cascade;                      ///< root 0 is the environment; of WholeTree::own there are none
    std::vector<std::int32_t> tile_curve; ///< one a tile: its first curve; -1: it is a cell

    /// The sum of the shares of the cells of a tile: its part of the environment.
    double tile_cost(std::size_t tile) const override { return cost_[tile]; }
    /// Without an MIS partner.
    std::vector<LitCell> lit_cells(std::size_t tile) const override;

    /// Calls `visit(part)` for each cell of a tile.
    template <class Visit>
    void for_each_cell(std::size_t tile, const Visit& visit) const {
        compress::for_each_cell(curves_.partition(tile).parts(), pruned_[tile], visit);
    }

private:
    double child_cost(std::uint32_t child) const {
        return child & TileTree::tile ? cost_[child & ~TileTree::tile] : split_cost_[child];
    }
    std::int32_t add(std::uint32_t child);
    std::int32_t add_tile(std::uint32_t tile, WholeTree whole);
    void add_tiles();
    std::int32_t add_split(std::uint32_t split);

    const TileTree& tiles_;
    const TileCurves& curves_;
    std::vector<Pruned> pruned_;
    std::vector<double> cost_, split_cost_;
};

} // namespace acdf::compress
