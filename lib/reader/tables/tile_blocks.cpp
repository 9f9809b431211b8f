// Divides the square by the splits, as finely as grid and blocks tell apart.
#include "tables/tile_blocks.h"

#include <algorithm>

namespace acdf {

namespace {

using u32 = std::uint32_t;

constexpr std::size_t kGridATile = 16;
constexpr u32 kMostEntryBits = 15; // so that the numbers of blocks fit into an entry
constexpr u32 kBlock = 4;          // entries along each side

} // namespace

bool TileBlocksMaker::make(const AcdfBlend& blend, u32 columns, u32 rows) noexcept {
    blend_ = blend;
    const u32 end[2] = {columns, rows};
    u32 bits[2] = {};
    // As fine as positions or as there are entries for, as near to squares as can be.
    for (int axis = 0; axis < 2; ++axis)
        while (u32{1} << tables_.shift[axis] < end[axis]) ++tables_.shift[axis];
    for (u32 all = 0; all < kMostEntryBits && std::size_t{1} << all < kGridATile * blend.tiles->tile_count; ++all) {
        const int axis = tables_.shift[0] >= tables_.shift[1] ? 0 : 1;
        if (tables_.shift[axis] == 0) break;
        --tables_.shift[axis];
        ++bits[axis];
    }
    for (int axis = 0; axis < 2; ++axis) tables_.fine[axis] = std::max(tables_.shift[axis], 2u) - 2;
    tables_.bits0 = bits[0];
    // Block 0 is looked at where there is no need for any.
    if (!grid_.add(std::size_t{1} << (bits[0] + bits[1]), 0) || !blocks_.add(kBlock * kBlock, ACDF_TILE_FLAG))
        return false;
    divide(acdf_blend_root(&blend), {{0, 0}, {u32{1} << bits[0], u32{1} << bits[1]}}, tables_.shift, false);
    return !blocks_.failed();
}

// Entries of what lies in a node. Those that a split cuts are left to blocks, in blocks to the walk from there. A
// path passes at most ACDF_MAX_SPLITS_DEEP splits.
void TileBlocksMaker::divide(u32 node, const Box& entries, const u32 shift[2], bool in_block) {
    if (entries.low[0] >= entries.high[0] || entries.low[1] >= entries.high[1]) return;
    if (node & ACDF_TILE_FLAG) return fill(node, entries, in_block);
    const AcdfSplit& split = blend_.splits[node];
    const u32 axis = split.place & 7u, position = split.place >> 3;
    const u32 below = position >> shift[axis], above = below + ((below << shift[axis]) < position ? 1 : 0);
    Box part = entries;
    part.high[axis] = std::min(entries.high[axis], below);
    divide(split.child[0], part, shift, in_block);
    part.low[axis] = std::max(entries.low[axis], below);
    part.high[axis] = std::min(entries.high[axis], above);
    if (part.low[axis] < part.high[axis]) fill(node, part, in_block);
    part.low[axis] = std::max(entries.low[axis], above);
    part.high[axis] = entries.high[axis];
    divide(split.child[1], part, shift, in_block);
}

void TileBlocksMaker::fill(u32 node, const Box& entries, bool in_block) {
    for (u32 row = entries.low[1]; row < entries.high[1]; ++row)
        for (u32 column = entries.low[0]; column < entries.high[0]; ++column) {
            if (in_block)
                blocks_[blocks_.size() - kBlock * kBlock + kBlock * (row - first_[1]) + column - first_[0]] =
                    static_cast<std::uint16_t>(node);
            else if (node & ACDF_TILE_FLAG)
                grid_[(std::size_t{row} << tables_.bits0) + column] = static_cast<std::uint16_t>(node);
            else add_block(node, column, row);
        }
}

// The block of an entry of the grid: it may reach past that where a side of the entry has less than four positions.
void TileBlocksMaker::add_block(u32 node, u32 column, u32 row) {
    grid_[(std::size_t{row} << tables_.bits0) + column] =
        static_cast<std::uint16_t>(blocks_.size() / (kBlock * kBlock));
    if (!blocks_.add(kBlock * kBlock, 0)) return;
    const u32 at[2] = {column, row};
    Box entries;
    for (int axis = 0; axis < 2; ++axis) {
        first_[axis] = at[axis] << tables_.shift[axis] >> tables_.fine[axis] & ~(kBlock - 1);
        entries.low[axis] = first_[axis];
        entries.high[axis] = first_[axis] + kBlock;
    }
    divide(node, entries, tables_.fine, true);
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
