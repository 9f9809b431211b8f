// Follows the splits to each tile, and finds how deep in them each part of the square is.
#include "tables/tiles.h"

#include <algorithm>

namespace acdf {

namespace {

using u32 = std::uint32_t;

constexpr std::size_t kCodes = 256;
constexpr std::size_t kLine = 64; // bytes

} // namespace

TileTablesMaker::TileTablesMaker(const AcdfBlend& blend, u32 columns, u32 rows) noexcept
    : blend_(blend), end_{columns, rows} {}

bool TileTablesMaker::make() noexcept {
    const std::size_t tiles = blend_.tiles->tile_count;
    if (!arrange() || !tiles_.add(tiles, {})) return false;
    follow(acdf_blend_root(&blend_), {{0, 0}, {end_[0], end_[1]}}, 0);
    bits_ = GridBits(end_, tiles);
    if (!grid_.add(bits_.count(), 0)) return false;
    divide(blend_, acdf_blend_root(&blend_), bits_.all(), bits_.shift,
           [this](u32 node, const Entries& entries) { fill(node, entries); });
    return !paths_.failed();
}

// How many splits there are from a node on.
u32 TileTablesMaker::size(u32 node) const { return node & ACDF_TILE_FLAG ? 0 : sizes_[node]; }

void TileTablesMaker::give(u32 split) { numbers_[split] = static_cast<std::uint16_t>(used_++); }

u32 TileTablesMaker::renumbered(u32 node) const { return node & ACDF_TILE_FLAG ? node : numbers_[node]; }

// Gives numbers to splits, so that a way passes few cache lines of a row.
bool TileTablesMaker::arrange() {
    const std::size_t splits = blend_.tiles->tile_count - 1;
    if (splits == 0) return true;
    if (!numbers_.add(splits, 0) || !sizes_.add(splits, 0)) return false;
    for (std::size_t i = splits; i-- > 0;) // children stand behind
        sizes_[i] =
            static_cast<std::uint16_t>(1 + size(blend_.splits[i].child[0]) + size(blend_.splits[i].child[1]));
    tops_.add(0);
    for (std::size_t i = 0; i < tops_.size() && used_ < ACDF_TILE_FLAG; ++i) arrange(tops_[i]);
    return used_ < ACDF_TILE_FLAG && !tops_.failed();
}

// A split and what is nearest below it, level by level, in one line. What is left, below, is a top of its own.
void TileTablesMaker::arrange(u32 top) {
    const std::size_t room = kLine - used_ % kLine;
    if (std::min<std::size_t>(sizes_[top], kLine) > room) used_ += room;
    std::uint16_t line[kLine] = {static_cast<std::uint16_t>(top)};
    for (std::size_t next = 0, count = 1; next < count; ++next) {
        give(line[next]);
        for (const u32 child : blend_.splits[line[next]].child) {
            if (child & ACDF_TILE_FLAG) continue;
            if (count < kLine) line[count++] = static_cast<std::uint16_t>(child);
            else tops_.add(static_cast<std::uint16_t>(child));
        }
    }
}

// A path passes at most ACDF_MAX_SPLITS_DEEP splits.
void TileTablesMaker::follow(u32 node, const Box& box, u32 depth) {
    if (node & ACDF_TILE_FLAG) {
        AcdfTileRecord& tile = tiles_[node & ~ACDF_TILE_FLAG];
        std::copy_n(box.low, 2, tile.low);
        std::copy_n(box.high, 2, tile.high);
        tile.root = blend_.roots ? blend_.roots[node & ~ACDF_TILE_FLAG] : ACDF_NO_ROOT;
        tile.depth = static_cast<std::uint16_t>(depth);
        if (depth <= ACDF_TILE_STEPS) {
            std::copy_n(way_, depth, tile.step);
            return;
        }
        tile.step[0] = static_cast<std::uint16_t>(paths_.size());
        tile.step[1] = static_cast<std::uint16_t>(paths_.size() >> 16);
        for (u32 i = 0; i < depth; ++i) paths_.add(way_[i]);
        return;
    }
    const AcdfSplit& split = blend_.splits[node];
    const u32 axis = split.place & 7u, number = numbers_[node];
    Box half = box;
    half.high[axis] = split.place >> 3;
    way_[depth] = static_cast<std::uint16_t>(2 * number);
    follow(split.child[0], half, depth + 1);
    half.low[axis] = half.high[axis];
    half.high[axis] = box.high[axis];
    way_[depth] = static_cast<std::uint16_t>(2 * number + 1);
    follow(split.child[1], half, depth + 1);
}

void TileTablesMaker::fill(u32 node, const Entries& entries) {
    const auto entry = static_cast<std::uint16_t>(renumbered(node));
    for (u32 row = entries.low[1]; row < entries.high[1]; ++row) {
        std::uint16_t* const begin = grid_.data() + (std::size_t{row} << bits_.bits[0]);
        std::fill(begin + entries.low[0], begin + entries.high[0], entry);
    }
}

std::size_t TileTablesMaker::stride() const noexcept { return (used_ + kLine - 1) / kLine * kLine; }

// With a line more: instead of a split below a tile a traversal looks at any other.
std::size_t TileTablesMaker::row_words() const noexcept {
    return used_ > 0 && blend_.rows ? (blend_.tiles->row_count * stride() + kLine) / 4 : 0;
}

std::size_t TileTablesMaker::split_words() const noexcept { return 2 * (stride() + kLine); }

std::size_t TileTablesMaker::words() const noexcept {
    return whole_lines(4 * kCodes) + split_words() + row_words() + whole_lines(tiles_.bytes() / 4) +
           whole_lines((paths_.bytes() + 3) / 4) + whole_lines((grid_.bytes() + 3) / 4);
}

std::size_t TileTablesMaker::place(u32* words, std::size_t at, AcdfTileTables& out) const noexcept {
    const std::size_t splits = blend_.tiles->tile_count - 1;
    out.codes = static_cast<u32>(at);
    auto* const codes = reinterpret_cast<double*>(words + at);
    for (std::size_t i = 0; i < kCodes; ++i) { // as acdf_blend_find_rows reckons
        codes[2 * i] = blend_.tiles->codebook[i] * (1.0 / 65535.0);
        codes[2 * i + 1] = (65535.0 - blend_.tiles->codebook[i]) * (1.0 / 65535.0);
    }
    at = whole_lines(at + 4 * kCodes);
    out.splits = static_cast<u32>(at);
    for (std::size_t i = 0; i < splits; ++i) {
        AcdfSplit split = blend_.splits[i];
        for (std::uint16_t& child : split.child) child = static_cast<std::uint16_t>(renumbered(child));
        reinterpret_cast<AcdfSplit*>(words + at)[numbers_[i]] = split;
    }
    at = whole_lines(at + 2 * stride());
    out.rows = static_cast<u32>(at);
    const std::size_t rows =
        splits > 0 && blend_.rows ? blend_.tiles->row_count : 0; // without splits any number of them takes no byte
    const std::uint16_t* const numbers = numbers_.data(); // which stored bytes might be, for all a compiler knows
    for (std::size_t row = 0; row < rows; ++row) {
        const std::uint8_t* const from = blend_.rows + row * splits;
        auto* const to = reinterpret_cast<std::uint8_t*>(words + at) + row * stride();
        for (std::size_t i = 0; i < splits; ++i) to[numbers[i]] = from[i];
    }
    at += row_words();
    out.stride = static_cast<u32>(stride());
    out.root = splits > 0 ? 0 : ACDF_TILE_FLAG;
    out.tiles = copy_lines(tiles_, words, at);
    out.paths = copy_lines(paths_, words, at);
    out.grid = copy_lines(grid_, words, at);
    out.shift[0] = bits_.shift[0];
    out.shift[1] = bits_.shift[1];
    out.bits0 = bits_.bits[0];
    return at;
}

std::size_t TileTablesMaker::heart_words() const noexcept {
    return used_ > 0 && blend_.rows && 2 * std::size_t{blend_.tiles->tile_count} < 65536
               ? whole_lines(blend_.tiles->row_count * stride() / 2)
               : 0;
}

// Children stand behind their splits, and tiles behind all of them: no branch asks which it is.
bool TileTablesMaker::prepare_hearts() noexcept {
    const std::size_t splits = blend_.tiles->tile_count - 1;
    if (!links_.add(2 * splits, 0) || !hearts_.add(splits + blend_.tiles->tile_count, 0)) return false;
    for (std::size_t i = 0; i < splits; ++i)
        for (int k = 0; k < 2; ++k) {
            const u32 child = blend_.splits[i].child[k], tile = child & ~ACDF_TILE_FLAG;
            links_[2 * i + static_cast<std::size_t>(k)] =
                static_cast<std::uint16_t>(child & ACDF_TILE_FLAG ? splits + tile : child);
        }
    for (std::size_t tile = 0; tile <= splits; ++tile) hearts_[splits + tile] = static_cast<std::uint16_t>(tile);
    return true;
}

void TileTablesMaker::place_hearts(std::uint16_t* out) noexcept {
    const std::size_t splits = blend_.tiles->tile_count - 1, step = stride(), rows = blend_.tiles->row_count;
    const std::uint16_t *const numbers = numbers_.data(), *const links = links_.data();
    std::uint16_t* const hearts = hearts_.data();
    std::uint8_t uppers[kCodes]; // whether a code gives more to the upper half
    for (std::size_t i = 0; i < kCodes; ++i) uppers[i] = blend_.tiles->codebook[i] < 32768u;
    for (std::size_t row = 0; row < rows; ++row, out += step) {
        const std::uint8_t* const codes = blend_.rows + row * splits;
        for (std::size_t i = splits; i-- > 0;)
            out[numbers[i]] = hearts[i] = hearts[links[2 * i + uppers[codes[i]]]];
    }
}

} // namespace acdf
