// Divides the square by the splits, as finely as grid and blocks resolve.
#include "tables/tile_blocks.h"

#include <algorithm>
#include <iterator>

namespace acdf {

namespace {

using u32 = std::uint32_t;

constexpr u32 kBlock = 4; // entries along each side

} // namespace

bool TileBlocksMaker::make(const AcdfBlend& blend, u32 columns, u32 rows) noexcept {
    blend_ = blend;
    const u32 end[2] = {columns, rows};
    const GridBits bits(end, blend.tiles->tile_count);
    tables_.bits0 = bits.bits[0];
    const u32* coarser = bits.shift;
    for (int axis = 0; axis < 2; ++axis) tables_.shift[axis] = bits.shift[axis];
    for (u32 i = 0; i < ACDF_TILE_BLOCK_LEVELS; coarser = tables_.fine[i++])
        for (int axis = 0; axis < 2; ++axis) tables_.fine[i][axis] = std::max(coarser[axis], 2u) - 2;
    if (!grid_.add(bits.count(), 0)) return false;
    u32 levels = 1;
    while (levels < ACDF_TILE_BLOCK_LEVELS && tables_.fine[levels - 1][0] + tables_.fine[levels - 1][1] > 0)
        ++levels;
    // The blocks of one level are no more than there are entries: numbers of both have 15 bits.
    do {
        if (!fill(bits.all(), levels)) return false;
    } while (overflows_ && levels-- > 1);
    return true;
}

// The grid and so many levels of blocks. False where memory fails.
bool TileBlocksMaker::fill(const Entries& all, u32 levels) noexcept {
    tables_.levels = levels;
    overflows_ = false;
    std::fill(std::begin(recent_), std::end(recent_), Cut{});
    blocks_.cut(0);
    divide(blend_, acdf_blend_root(&blend_), all, tables_.shift, [&](u32 node, const Entries& entries) {
        for (u32 row = entries.low[1]; row < entries.high[1]; ++row)
            for (u32 column = entries.low[0]; column < entries.high[0]; ++column)
                grid_[(std::size_t{row} << tables_.bits0) + column] =
                    static_cast<std::uint16_t>(finer(node, {tables_.shift, column, row}, 0));
    });
    // The first block is looked at where there is no need for any. Not one more than there are entries.
    if (blocks_.size() == 0) blocks_.add(kBlock * kBlock, ACDF_TILE_FLAG);
    return !blocks_.failed();
}

// An entry: the tile that holds it, or a block for what a split cuts; behind the last level that split.
u32 TileBlocksMaker::finer(u32 node, const Entry& entry, u32 level) {
    if (node & ACDF_TILE_FLAG || level == tables_.levels || overflows_) return node;
    const AcdfSplit& split = blend_.splits[node];
    const u32 axis = split.place & 7u, position = split.place >> 3;
    Entries half = {{entry.column << entry.shift[0], entry.row << entry.shift[1]},
                    {(entry.column + 1) << entry.shift[0], (entry.row + 1) << entry.shift[1]}};
    const u32 begin = half.low[axis];
    half.low[axis] = position;
    const u32 upper = uncut(split.child[1], half);
    half.low[axis] = begin;
    half.high[axis] = position;
    const u32 lower = uncut(split.child[0], half);
    if (!(lower & upper & ACDF_TILE_FLAG)) return add_block(node, entry, level);
    Cut cut = {split.place, static_cast<std::uint16_t>(lower), static_cast<std::uint16_t>(upper), level, 0};
    Cut& recent = recent_[((split.place ^ level ^ (lower << 16 | upper) * 0x9E3779B1u) * 0x85EBCA6Bu) >> 22];
    if (recent.place != cut.place || recent.lower != cut.lower || recent.upper != cut.upper ||
        recent.level != level) {
        cut.block = add_block(node, entry, level); // in which others may become recent
        recent = cut;
    }
    return recent.block;
}

// What holds all positions, or cuts them.
u32 TileBlocksMaker::uncut(u32 node, const Entries& positions) const {
    while (!(node & ACDF_TILE_FLAG)) {
        const AcdfSplit& split = blend_.splits[node];
        const u32 axis = split.place & 7u, position = split.place >> 3;
        if (positions.low[axis] < position && position < positions.high[axis]) break;
        node = split.child[position <= positions.low[axis]];
    }
    return node;
}

// Where an entry has less than four parts along a side, the block repeats them: it does not depend on where the
// entry lies.
u32 TileBlocksMaker::add_block(u32 node, const Entry& entry, u32 level) {
    const std::size_t first = blocks_.size(), number = first / (kBlock * kBlock);
    overflows_ = overflows_ || number >= ACDF_TILE_FLAG;
    if (overflows_ || !blocks_.add(kBlock * kBlock, 0)) return 0;
    const u32 *const fine = tables_.fine[level], at[2] = {entry.column, entry.row};
    Entries parts;
    u32 last[2]; // of the parts along a side
    for (int axis = 0; axis < 2; ++axis) {
        const u32 bits = entry.shift[axis] - fine[axis];
        last[axis] = (1u << bits) - 1;
        parts.low[axis] = at[axis] << bits;
        parts.high[axis] = (at[axis] + 1) << bits;
    }
    const auto part = [&](u32 x, u32 y) -> std::uint16_t& {
        return blocks_[first + kBlock * (y % kBlock) + x % kBlock];
    };
    divide(blend_, node, parts, fine, [&](u32 found, const Entries& entries) {
        for (u32 y = entries.low[1]; y < entries.high[1]; ++y)
            for (u32 x = entries.low[0]; x < entries.high[0]; ++x) {
                const u32 told = finer(found, {fine, x, y}, level + 1);
                part(x, y) = static_cast<std::uint16_t>(told);
            }
    });
    for (u32 y = 0; y < kBlock; ++y)
        for (u32 x = 0; x < kBlock; ++x)
            part(x, y) = part(parts.low[0] + (x & last[0]), parts.low[1] + (y & last[1]));
    return static_cast<u32>(number);
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
