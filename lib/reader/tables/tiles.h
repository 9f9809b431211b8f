// Makes the runtime tables of acdf/tile_tables.h.
#pragma once

#include "tables/entries.h"
#include "tables/growable.h"

#include <acdf/tile_tables.h>

#include <cstddef>
#include <cstdint>

namespace acdf {

class TileTablesMaker {
public:
    /// Positions on the axes run to columns and rows.
    TileTablesMaker(const AcdfBlend& blend, std::uint32_t columns, std::uint32_t rows) noexcept;

    /// False where memory fails, and where there are too many splits.
    bool make() noexcept;
    std::size_t words() const noexcept;
    /// Copies the tables to word `at` of all, a multiple of 16; returns what follows.
    std::size_t place(std::uint32_t* words, std::size_t at, AcdfTileTables& out) const noexcept;
    /// The tiles of each row that are reached from its splits by the brighter halves; 0 words where there is no
    /// split.
    std::size_t heart_words() const noexcept;
    bool prepare_hearts() noexcept; ///< false where memory fails
    void place_hearts(std::uint16_t* out) noexcept;

private:
    struct Box {
        std::uint32_t low[2], high[2];
    };
    std::size_t stride() const noexcept;
    std::size_t row_words() const noexcept;
    std::size_t split_words() const noexcept;
    bool arrange();
    void arrange(std::uint32_t top);
    std::uint32_t size(std::uint32_t node) const;
    void give(std::uint32_t split);
    std::uint32_t renumbered(std::uint32_t node) const;
    void follow(std::uint32_t node, const Box& box, std::uint32_t depth);
    void fill(std::uint32_t node, const Entries& entries);

    AcdfBlend blend_;
    std::uint32_t end_[2];
    GridBits bits_;
    std::uint16_t way_[ACDF_MAX_SPLITS_DEEP] = {};
    std::size_t used_ = 0; // numbers of splits
    Growable<std::uint16_t> numbers_, sizes_, tops_;
    Growable<AcdfTileRecord> tiles_;
    Growable<std::uint16_t> paths_, grid_;
    Growable<std::uint16_t> links_, hearts_; // of both halves of splits; of the splits of a row, then of tiles
};

} // namespace acdf
