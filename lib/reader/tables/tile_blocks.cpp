// Divides the square by the splits, as finely as grid and blocks tell apart.
#include "tables/tile_blocks.h"

#include <algorithm>

namespace acdf {

namespace {

using u32 = std::uint32_t;

constexpr u32 kBlock = 4; // entries along each side

} // namespace

bool TileBlocksMaker::make(const AcdfBlend& blend, u32 columns, u32 rows) noexcept {
    blend_ = blend;
    const u32 end[2] = {columns, rows};
    const GridBits bits(end, blend.tiles->tile_count);
    for (int axis = 0; axis < 2; ++axis) tables_.shift[axis] = bits.shift[axis];
    for (int axis = 0; axis < 2; ++axis) tables_.fine[axis] = std::max(tables_.shift[axis], 2u) - 2;
    tables_.bits0 = bits.bits[0];
    if (!grid_.add(bits.count(), 0)) return false;
    divide(blend_, acdf_blend_root(&blend_), bits.all(), tables_.shift,
           [this](u32 node, const Entries& entries) { fill(node, entries); });
    // The first block is looked at where there is no need for any. Not one more than there are entries: numbers of
    // blocks have 15 bits, and so have those of entries.
    if (blocks_.size() == 0) blocks_.add(kBlock * kBlock, ACDF_TILE_FLAG);
    return !blocks_.failed();
}

// Tiles, and blocks for entries that a split cuts.
void TileBlocksMaker::fill(u32 node, const Entries& entries) {
    for (u32 row = entries.low[1]; row < entries.high[1]; ++row)
        for (u32 column = entries.low[0]; column < entries.high[0]; ++column) {
            std::uint16_t& entry = grid_[(std::size_t{row} << tables_.bits0) + column];
            entry = static_cast<std::uint16_t>(node & ACDF_TILE_FLAG ? node : blocks_.size() / (kBlock * kBlock));
            if (!(node & ACDF_TILE_FLAG)) add_block(node, column, row);
        }
}

// The block of an entry of the grid: it may reach past that where a side of the entry has less than four positions.
// What splits cut there is left to the walk.
void TileBlocksMaker::add_block(u32 node, u32 column, u32 row) {
    std::uint16_t* const block = blocks_.add(kBlock * kBlock, 0);
    if (!block) return;
    const u32 at[2] = {column, row};
    Entries whole;
    for (int axis = 0; axis < 2; ++axis) {
        whole.low[axis] = at[axis] << tables_.shift[axis] >> tables_.fine[axis] & ~(kBlock - 1);
        whole.high[axis] = whole.low[axis] + kBlock;
    }
    divide(blend_, node, whole, tables_.fine, [&](u32 found, const Entries& entries) {
        for (u32 y = entries.low[1]; y < entries.high[1]; ++y)
            for (u32 x = entries.low[0]; x < entries.high[0]; ++x)
                block[kBlock * (y - whole.low[1]) + x - whole.low[0]] = static_cast<std::uint16_t>(found);
    });
}

std::size_t TileBlocksMaker::words() const noexcept {
    return whole_lines((grid_.bytes() + 3) / 4) + whole_lines((blocks_.bytes() + 3) / 4);
}

std::size_t TileBlocksMaker::place(u32* words, std::size_t at, AcdfTileBlocks& out) const noexcept {
    out = tables_;
    out.grid = copy_lines(grid_, words, at);
    out.blocks = copy_lines(blocks_, words, at);
    return at;
}

} // namespace acdf
