// The size of the tree of a whole environment before it is made: what the search for a price asks again and again.
#pragma once

#include "compress/fit/tree_size.h"
#include "compress/local/tile_curves.h"

#include <cstdint>
#include <vector>

namespace acdf::compress {

/// Sizes the trees of TileCascade at one price after the other. Tiles that a price leaves as they were are not
/// looked at again.
class TileSizer {
public:
    /// `most_ratio`, `before`: see encode_tree; the latter is of so many bytes. `tiles` and `curves` must outlive
    /// it.
    TileSizer(const TileTree& tiles, const TileCurves& curves, double most_ratio, WholeTree whole,
              std::size_t before);

    /// The bytes of encode_tree(TileCascade(tiles, curves, price, whole).cascade, `byte_price`, most_ratio,
    /// before).
    std::uint64_t bytes(double price, double byte_price);
    /// The partitions have changed.
    void forget();

private:
    /// The curves of a tile as it was pruned last.
    struct Inside {
        std::vector<std::uint32_t> begins;
        std::vector<std::uint8_t> divided;
        double cost = 0.0;
        SizedCurves curves;
        std::vector<KnownRoundings> roundings; ///< one a curve
    };
    struct Tree;

    void prune(double price);

    const TileTree& tiles_;
    const TileCurves& curves_;
    double most_ratio_;
    WholeTree whole_;
    std::size_t before_;
    std::vector<Inside> inside_; ///< one a tile
};

} // namespace acdf::compress
