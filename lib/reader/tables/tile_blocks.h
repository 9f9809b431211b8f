// Makes the runtime tables of acdf/tile_blocks.h.
#pragma once

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
    // Entries of the grid or of a block.
    struct Box {
        std::uint32_t low[2], high[2];
    };
    void divide(std::uint32_t node, const Box& entries, const std::uint32_t shift[2], bool in_block);
    void fill(std::uint32_t node, const Box& entries, bool in_block);
    void add_block(std::uint32_t node, std::uint32_t column, std::uint32_t row);

    AcdfBlend blend_ = {};
    AcdfTileBlocks tables_ = {};
    Growable<std::uint16_t> grid_, blocks_;
    std::uint32_t first_[2] = {}; // of the block that is filled
};

} // namespace acdf
