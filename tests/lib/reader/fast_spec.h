// Chunks SUMS and GRID, written from format/SPEC.md §10.6. Checks nothing.
#pragma once

#include "tests/lib/reader/files.h"

#include <cstddef>
#include <cstdint>
#include <vector>

namespace acdf_test {

/// A row of SUMS by its ends: those of groups, and of the tiles of all groups, one after the other.
struct FastRow {
    std::vector<std::uint16_t> groups;
    Bytes tiles;
};

/// The grid of a tile.
struct FastGrid {
    std::uint8_t shift[2] = {0, 0};
    Bytes lines;              ///< ends of the lines
    std::vector<Bytes> cells; ///< of each line the ends of its cells

    Bytes encode() const {
        Bytes out(shift, shift + 2);
        out.insert(out.end(), lines.begin(), lines.end());
        for (const Bytes& line : cells) out.insert(out.end(), line.begin(), line.end());
        return out;
    }
};

struct FastSpec {
    std::vector<FastRow> rows;
    std::vector<FastGrid> grids; ///< one a tile

    /// Of each tile, and behind the last one.
    std::vector<std::uint32_t> roots() const {
        std::vector<std::uint32_t> out = {0};
        for (const FastGrid& grid : grids)
            out.push_back(out.back() + static_cast<std::uint32_t>(grid.encode().size()));
        return out;
    }
    Bytes grid_chunk() const {
        Bytes out;
        for (const FastGrid& grid : grids) {
            const Bytes bytes = grid.encode();
            out.insert(out.end(), bytes.begin(), bytes.end());
        }
        out.resize(out.size() + 64, 0);
        return out;
    }
    Bytes sum_chunk() const {
        Bytes out;
        for (const FastRow& row : rows)
            for (std::size_t g = 0; g < (row.groups.size() + 15) / 16 * 16; ++g)
                put16(out, g < row.groups.size() ? row.groups[g] : 32767);
        for (const FastRow& row : rows)
            for (std::size_t i = 0; i < 16 * row.groups.size(); ++i)
                out.push_back(i < row.tiles.size() ? row.tiles[i] : 255);
        return out;
    }
};

} // namespace acdf_test
