// Grids over the positions of the axes whose entries say what the splits of tiles lead to.
#pragma once

#include <acdf/blend.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>

namespace acdf {

/// Entries of a grid, from the low ones up to before the high ones.
struct Entries {
    std::uint32_t low[2], high[2];
};

/// As fine as positions, which run to `end`, or as there are entries for, as near to squares as can be.
struct GridBits {
    std::uint32_t shift[2] = {}, bits[2] = {}; ///< bits of positions that are finer than the grid; its own

    GridBits() = default;
    GridBits(const std::uint32_t end[2], std::size_t tiles) {
        constexpr std::size_t entries_a_tile = 16;
        constexpr std::uint32_t most_bits = 15; // so that numbers of entries fit into 16 bits beside a flag
        for (int axis = 0; axis < 2; ++axis)
            while (std::uint32_t{1} << shift[axis] < end[axis]) ++shift[axis];
        for (std::uint32_t all = 0; all < most_bits && std::size_t{1} << all < entries_a_tile * tiles; ++all) {
            const int axis = shift[0] >= shift[1] ? 0 : 1;
            if (shift[axis] == 0) break;
            --shift[axis];
            ++bits[axis];
        }
    }
    std::size_t count() const { return std::size_t{1} << (bits[0] + bits[1]); }
    Entries all() const { return {{0, 0}, {std::uint32_t{1} << bits[0], std::uint32_t{1} << bits[1]}}; }
};

/// Calls fill(node, entries) for all entries that lie in a node: with the tile that holds them, or the first split
/// that cuts them. A path passes at most ACDF_MAX_SPLITS_DEEP splits.
template <class Fill>
void divide(const AcdfBlend& blend, std::uint32_t node, Entries entries, const std::uint32_t shift[2],
            const Fill& fill) {
    while (!(node & ACDF_TILE_FLAG)) {
        const AcdfSplit& split = blend.splits[node];
        const std::uint32_t axis = split.place & 7u, position = split.place >> 3;
        const std::uint32_t below = position >> shift[axis],
                            above = below + ((below << shift[axis]) < position ? 1 : 0);
        if (below >= entries.high[axis] || above <= entries.low[axis]) { // all are on one side
            node = split.child[above <= entries.low[axis]];
            continue;
        }
        Entries part = entries;
        part.high[axis] = below;
        if (part.low[axis] < below) divide(blend, split.child[0], part, shift, fill);
        part.low[axis] = below;
        part.high[axis] = above;
        if (below < above) fill(node, part);
        if (above >= entries.high[axis]) return;
        entries.low[axis] = above;
        node = split.child[1];
    }
    fill(node, entries);
}

} // namespace acdf
