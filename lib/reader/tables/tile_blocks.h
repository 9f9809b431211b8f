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
    void fill(std::uint32_t node, const Entries& entries);
    void add_block(std::uint32_t node, std::uint32_t column, std::uint32_t row);

    AcdfBlend blend_ = {};
    AcdfTileBlocks tables_ = {};
    Growable<std::uint16_t> grid_, blocks_;
};

} // namespace acdf
