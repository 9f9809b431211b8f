#include "make_local_tables.h"

#include "make_sides.h"
#include "make_squares.h"
#include "memory.h"

#include <algorithm>
#include <cstring>
#include <new>

namespace acdf {

namespace {

using u32 = std::uint32_t;

std::size_t padded(std::size_t words) { return (words + 15) & ~std::size_t{15}; }

// Where tables are larger, calls would wait for memory longer than the walk takes.
constexpr std::size_t kMostBytes = std::size_t{3} << 20;

constexpr std::size_t kMostPieces = 65535; // what lists can name

class LocalTablesMaker {
public:
    LocalTablesMaker(const AcdfLocal& local, u32 tree_units, std::size_t most_bytes)
        : local_(local), most_bytes_(std::min(most_bytes, kMostBytes)),
          most_cells_(2 * std::size_t{tree_units} + local.blend.tiles->tile_count),
          most_pieces_(std::min(kMostPieces, most_bytes_ / (2 * sizeof(AcdfTilePiece)))),
          sides_(local.environment.columns, local.environment.rows) {}

    /// False where there can be no tables.
    bool gather();
    AcdfLocalTables* assemble(const AcdfAllocator& allocator, AcdfBlock& block) const;

private:
    bool gather(u32 node, const Cell& box);
    bool add(const Cell& cell, u32 tile);
    void add_parts(const std::uint8_t* row, u32 node, double product, double* out) const;

    AcdfLocal local_;
    std::size_t most_bytes_, most_cells_, most_pieces_, cells_ = 0;
    Sides sides_;
    Growable<AcdfTilePiece> pieces_;
    Growable<KeyBox> keys_;
    SquaresMaker directions_;
};

bool LocalTablesMaker::gather() {
    const AcdfEnvironment& env = local_.environment;
    const AcdfTiles& tiles = *local_.blend.tiles;
    if (sizeof(double) * tiles.row_count * tiles.tile_count > most_bytes_) return false;
    const Cell whole = {1.0, {0.0, 0.0}, {1.0, 1.0}, {0, 0}, {env.columns, env.rows}, false, false};
    return sides_.remember(most_cells_) && gather(tiles.tile_count > 1 ? 0 : ACDF_TILE_FLAG, whole) &&
           !(pieces_.failed() || keys_.failed()) &&
           directions_.make(keys_.data(), keys_.size(), ACDF_DIRECTION_BITS);
}

// The cells of all tiles below a node. A path passes at most 48 splits.
bool LocalTablesMaker::gather(u32 node, const Cell& box) {
    if (!(node & ACDF_TILE_FLAG)) {
        const AcdfSplit& split = local_.blend.splits[node];
        const u32 axis = split.place & 7u;
        Cell lower = box, upper = box;
        lower.last[axis] = upper.first[axis] = split.place >> 3;
        return gather(split.child[0], lower) && gather(split.child[1], upper);
    }
    const u32 tile = node & ~ACDF_TILE_FLAG, root = local_.blend.roots ? local_.blend.roots[tile] : ACDF_NO_ROOT;
    if (root == ACDF_NO_ROOT) return add(box, tile);
    return each_cell(local_.blend.tree, root, box, [&](const Cell& cell) { return add(cell, tile); });
}

// False where there are too many cells, or more than the file has bytes, as curves may be shared. Those with tilts
// are left to the walk.
bool LocalTablesMaker::add(const Cell& cell, u32 tile) {
    if (++cells_ > most_cells_) return false;
    if (cell.tilted) return true;
    const double probability = cell.dark ? 0.0 : acdf_positive(cell.probability);
    const double area = 2.0 * ACDF_PI * static_cast<double>(cell.last[0] - cell.first[0]) * sides_.height(cell);
    Side columns[5], rows[2]; // set as far as they are counted
    const int column_count = sides_.azimuths(cell, columns), row_count = sides_.heights(cell, rows);
    for (int r = 0; r < row_count; ++r)
        for (int c = 0; c < column_count; ++c) {
            const Side& azimuth = columns[c];
            const Side& height = rows[r];
            const bool south = height.piece == 1; // 1 - |z| falls from the equator on
            const double from[2] = {azimuth.local[0] - azimuth.margin[0],
                                    height.local[south] + height.margin[south]};
            const double width[2] = {from[0] - (azimuth.local[1] + azimuth.margin[1]),
                                     height.local[!south] - height.margin[!south] - from[1]};
            if (!(width[0] > 0.0 && width[1] > 0.0)) continue;
            pieces_.add({{static_cast<float>(from[0]), static_cast<float>(from[1])},
                         {static_cast<float>(width[0]), static_cast<float>(width[1])},
                         tile,
                         0,
                         probability,
                         area});
            keys_.add({{static_cast<u32>(azimuth.key[0]), static_cast<u32>(height.key[0])},
                       {static_cast<u32>(azimuth.key[1]), static_cast<u32>(height.key[1])}});
        }
    return pieces_.size() <= most_pieces_;
}

AcdfLocalTables* LocalTablesMaker::assemble(const AcdfAllocator& allocator, AcdfBlock& block) const {
    const AcdfBlend& blend = local_.blend;
    const std::size_t tiles = blend.tiles->tile_count, rows = blend.tiles->row_count;
    const std::size_t begin = sizeof(AcdfLocalTables) / 4;
    static_assert(sizeof(AcdfLocalTables) % 64 == 0, "arrays are aligned");
    const std::size_t piece_words = padded(pieces_.bytes() / 4), part_words = padded(2 * rows * tiles);
    const std::size_t words = begin + piece_words + directions_.words() + part_words + padded((tiles + 3) / 4);
    if (4 * words > most_bytes_) return nullptr;
    block = take_block(allocator, 4 * words);
    if (!block.data) return nullptr;
    u32* const out = static_cast<u32*>(std::memset(block.data, 0, 4 * words));
    AcdfLocalTables* const tables = new (block.data) AcdfLocalTables();
    tables->words = static_cast<u32>(words);
    tables->count = static_cast<u32>(pieces_.size());
    tables->pieces = static_cast<u32>(begin);
    if (pieces_.size() > 0) std::memcpy(out + begin, pieces_.data(), pieces_.bytes());
    tables->parts = static_cast<u32>(directions_.place(out, begin + piece_words, tables->directions));
    tables->lights = tables->parts + static_cast<u32>(part_words);
    auto* const parts = reinterpret_cast<double*>(out + tables->parts);
    for (std::size_t i = 0; i < rows; ++i)
        add_parts(blend.rows + i * (tiles - 1), tiles > 1 ? 0 : ACDF_TILE_FLAG, 1.0, parts + i * tiles);
    auto* const lights = reinterpret_cast<std::uint8_t*>(out + tables->lights);
    for (u32 i = 0; i < local_.light_count; ++i) lights[local_.lights[i].tile] = static_cast<std::uint8_t>(i + 1);
    return tables;
}

// What a row gives to each tile: the products of its splits, as acdf_blend_find_tile forms them.
void LocalTablesMaker::add_parts(const std::uint8_t* row, u32 node, double product, double* out) const {
    const AcdfBlend& blend = local_.blend;
    while (!(node & ACDF_TILE_FLAG)) {
        const AcdfSplit& split = blend.splits[node];
        const double code = blend.tiles->codebook[row[node]];
        add_parts(row, split.child[1], product * ((65535.0 - code) * (1.0 / 65535.0)), out);
        product *= code * (1.0 / 65535.0);
        node = split.child[0];
    }
    out[node & ~ACDF_TILE_FLAG] = product;
}

} // namespace

AcdfLocalTables* make_local_tables(const AcdfLocal& local, u32 tree_units, std::size_t most_bytes,
                                   const AcdfAllocator& allocator, AcdfBlock& block) noexcept {
    LocalTablesMaker maker(local, tree_units, most_bytes);
    return maker.gather() ? maker.assemble(allocator, block) : nullptr;
}

} // namespace acdf
