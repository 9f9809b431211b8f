// Makes the runtime tables of acdf/tile_blocks.h.
#pragma once

#include "tables/entries.h"
#include "tables/growable.h"

#include <acdf/blend.h>
#include <acdf/tile_blocks.h>

#include <cstddef>
#include <cstdint>

namespace acdf {

class TileBlocksMaker {
public:
    /// False where memory fails. Positions on the axes run to columns and rows.
    bool make(const AcdfBlend& blend, std::uint32_t columns, std::uint32_t rows) noexcept;
    std::size_t words() const noexcept;
    /// Copies the tables to word `at` of all, a multiple of 16; returns what follows.
    std::size_t place(std::uint32_t* words, std::size_t at, AcdfTileBlocks& out) const noexcept;

private:
    /// An entry of the grid, or of a block.
    struct Entry {
        const std::uint32_t* shift; ///< bits of positions that are finer
        std::uint32_t column, row;
    };
    /// An entry that one split cuts, between two tiles.
    struct Cut {
        std::uint32_t place;
        std::uint16_t lower, upper;
        std::uint32_t level, block;
    };
    bool fill(const Entries& all, std::uint32_t levels) noexcept;
    std::uint32_t finer(std::uint32_t node, const Entry& entry, std::uint32_t level);
    std::uint32_t uncut(std::uint32_t node, const Entries& positions) const;
    std::uint32_t add_block(std::uint32_t node, const Entry& entry, std::uint32_t level);

    AcdfBlend blend_ = {};
    AcdfTileBlocks tables_ = {};
    Growable<std::uint16_t> grid_, blocks_;
    Cut recent_[1024];       ///< by what is in them
    bool overflows_ = false; ///< there are more blocks than numbers
};

} // namespace acdf
