#include "tables/local.h"

#include "memory.h"
#include "tables/sides.h"
#include "tables/squares.h"
#include "tables/tiles.h"

#include <acdf/box_middle.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <new>

namespace acdf {

namespace {

using u32 = std::uint32_t;

// Of pieces and parts: where they are larger, calls would wait for memory longer than the traversal takes.
constexpr std::size_t kMostBytes = std::size_t{3} << 20;

class PiecesMaker {
public:
    PiecesMaker(const AcdfLocal& local, u32 tree_units, std::size_t most_bytes)
        : local_(local), most_bytes_(std::min(most_bytes, kMostBytes)),
          most_cells_(2 * std::size_t{tree_units} + local.blend.tiles->tile_count),
          most_pieces_(std::min(kMostPieces, most_bytes_ / (2 * sizeof(AcdfTilePiece)))),
          sides_(acdf_environment_grid(&local.environment)) {}

    /// False where there can be none.
    bool make();
    std::size_t words() const;
    std::size_t place(u32* words, std::size_t at, AcdfLocalTables& out) const;

private:
    std::size_t part_words() const;
    bool gather();
    bool gather(u32 node, const Cell& box);
    bool add(const Cell& cell, u32 tile);
    void add_parts(const std::uint8_t* row, u32 node, double product, double* out) const;

    AcdfLocal local_;
    std::size_t most_bytes_, most_cells_, most_pieces_, cells_ = 0;
    Sides sides_;
    Growable<AcdfTilePiece> pieces_;
    KeyBoxes keys_;
    SquaresMaker directions_;
};

bool PiecesMaker::make() { return gather() && 4 * words() <= most_bytes_; }

bool PiecesMaker::gather() {
    const AcdfEnvironment& env = local_.environment;
    const AcdfTiles& tiles = *local_.blend.tiles;
    if (sizeof(double) * tiles.row_count * tiles.tile_count > most_bytes_) return false;
    const Cell whole = {1.0, {0.0, 0.0}, {1.0, 1.0}, {0, 0}, {env.columns, env.rows}, false, false};
    return sides_.remember(most_cells_) && gather(acdf_blend_root(&local_.blend), whole) &&
           !(pieces_.failed() || keys_.failed()) && directions_.make(keys_, sides_.key_bits());
}

// The cells of all tiles below a node. A path passes at most 48 splits.
bool PiecesMaker::gather(u32 node, const Cell& box) {
    if (!(node & ACDF_TILE_FLAG)) {
        const AcdfSplit& split = local_.blend.splits[node];
        const u32 axis = split.place & 7u;
        Cell lower = box, upper = box;
        lower.last[axis] = upper.first[axis] = split.place >> 3;
        return gather(split.child[0], lower) && gather(split.child[1], upper);
    }
    const u32 tile = node & ~ACDF_TILE_FLAG, root = local_.blend.roots ? local_.blend.roots[tile] : ACDF_NO_ROOT;
    if (root == ACDF_NO_ROOT) return add(box, tile);
    return each_cell(local_.blend.tree, root, box, [&](const Cell& above, u32 axis, const CellPart& part) {
        return add(part.in(above, axis), tile);
    });
}

// False where there are too many cells, or more than the file has bytes, as curves may be shared. Those with tilts
// are left to the traversal.
bool PiecesMaker::add(const Cell& cell, u32 tile) {
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
            keys_.add({azimuth.first_key(), azimuth.last_key()}, {height.first_key(), height.last_key()});
        }
    return pieces_.size() <= most_pieces_;
}

std::size_t PiecesMaker::part_words() const {
    return whole_lines(2 * std::size_t{local_.blend.tiles->row_count} * local_.blend.tiles->tile_count);
}
std::size_t PiecesMaker::words() const {
    return whole_lines(pieces_.bytes() / 4) + directions_.words() + part_words();
}

std::size_t PiecesMaker::place(u32* words, std::size_t at, AcdfLocalTables& out) const {
    const AcdfBlend& blend = local_.blend;
    const std::size_t tiles = blend.tiles->tile_count;
    out.count = static_cast<u32>(pieces_.size());
    out.pieces = static_cast<u32>(at);
    if (pieces_.size() > 0) std::memcpy(words + at, pieces_.data(), pieces_.bytes());
    at = directions_.place(words, at + whole_lines(pieces_.bytes() / 4), out.directions);
    out.parts = static_cast<u32>(at);
    auto* const parts = reinterpret_cast<double*>(words + at);
    for (std::size_t i = 0; i < blend.tiles->row_count; ++i)
        add_parts(blend.rows + i * (tiles - 1), acdf_blend_root(&blend), 1.0, parts + i * tiles);
    return at + part_words();
}

// What a row gives to each tile: the products of its splits, as acdf_blend_find_tile forms them.
void PiecesMaker::add_parts(const std::uint8_t* row, u32 node, double product, double* out) const {
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

constexpr u32 kMostSubdivisions = 32; // of an octahedron whose triangles are stored in a table

constexpr double kFacetMargin = 0x1p-6; // of a length: so far from a horizon sums lose no more than that

std::size_t facet_words(const AcdfLocal& local) {
    const std::size_t n = local.subdivisions;
    return n > 0 && n <= kMostSubdivisions ? whole_lines(8 * n * n * sizeof(AcdfFacet) / 4) : 0;
}

// Where normals between three corners see a bright tile: 1 above all their horizons, -1 below all, 0 neither.
int side_of(const AcdfBrightTile& light, const double (*corner)[3]) {
    double least = 1e300, most = -1e300, length = 0.0;
    for (int i = 0; i < 3; ++i) {
        const double* const n = corner[i];
        double height = 0.0;
        for (int axis = 0; axis < 3; ++axis) height += n[axis] * static_cast<double>(light.direction[axis]);
        least = std::min(least, height);
        most = std::max(most, height);
        length = std::max(length, std::sqrt(n[0] * n[0] + n[1] * n[1] + n[2] * n[2]));
    }
    /* heights are linear in normals, none of which is longer */
    const double far = (static_cast<double>(light.radius) + kFacetMargin) * length;
    return least >= far ? 1 : most <= -far ? -1 : 0;
}

// What normals between three corners see of bright tiles.
void place_lights_of(const AcdfLocal& local, const double (*corner)[3], AcdfFacet& facet) {
    for (u32 k = 0; k < local.bright_tile_count; k += 2) {
        const u32 end = std::min(k + 2, local.bright_tile_count);
        int side[2] = {-1, -1};
        for (u32 i = k; i < end; ++i) side[i - k] = side_of(local.bright_tiles[i], corner);
        if (side[0] == 0 || side[1] == 0) {
            facet.others |= 1u << k / 2;
            continue;
        }
        for (u32 i = k; i < end; ++i)
            for (int axis = 0; axis < 3 && side[i - k] > 0; ++axis)
                facet.whole[axis] += static_cast<double>(local.bright_tiles[i].share) *
                                     static_cast<double>(local.bright_tiles[i].direction[axis]);
    }
}

// The triangle between three corners.
void place_facet(const AcdfLocal& local, const std::int32_t (*corner)[3], AcdfFacet& facet) {
    double at[3][3];
    for (int i = 0; i < 3; ++i) {
        const std::int32_t *const c = corner[i], square = c[0] * c[0] + c[1] * c[1] + c[2] * c[2];
        for (int axis = 0; axis < 3; ++axis) at[i][axis] = static_cast<double>(c[axis]);
        const AcdfBin& bin = local.bins[acdf_octahedral_corner(local.subdivisions, c[0], c[1], c[2])];
        if (bin.root == ACDF_NO_ROOT) continue;
        facet.length[i] = std::sqrt(static_cast<double>(square));
        facet.share[i] = bin.share;
        facet.row[i] = bin.root;
    }
    place_lights_of(local, at, facet);
}

// All triangles, as acdf_local_facet numbers them.
void place_facets(const AcdfLocal& local, AcdfFacet* out) {
    const auto n = static_cast<std::int32_t>(local.subdivisions);
    for (std::int32_t octant = 0; octant < 8; ++octant)
        for (std::int32_t x = 0; x < n; ++x)
            for (std::int32_t y = 0; y < n; ++y, ++out) {
                const bool down = x + y >= n; // counted from the other side
                std::int32_t corner[3][3];
                for (int i = 0; i < 3; ++i) {
                    std::int32_t* const c = corner[i];
                    c[0] = (down ? n - 1 - x : x) + (down != (i == 0));
                    c[1] = (down ? n - 1 - y : y) + (down != (i == 1));
                    c[2] = n - c[0] - c[1];
                    for (int axis = 0; axis < 3; ++axis) c[axis] = octant >> axis & 1 ? -c[axis] : c[axis];
                }
                place_facet(local, corner, *out);
            }
}

void place_lights(const AcdfLocal& local, AcdfBrightTilePair* out) {
    for (u32 k = 0; k < local.bright_tile_count; k += 2) acdf_local_bright_tile_pair(&local, k, out++);
}

// Of each tile the direction of its middle.
void place_middles(const AcdfLocal& local, const AcdfLocalTables& tables, float* out) {
    for (u32 tile = 0; tile < local.blend.tiles->tile_count; ++tile, out += 3) {
        const AcdfTileRecord& record = *acdf_local_tile(&tables, tile);
        const u32 box[2][2] = {{record.high[0], record.low[0]}, {record.high[1], record.low[1]}};
        acdf_box_middle(&local, box, out);
    }
}

} // namespace

AcdfLocalTables* make_local_tables(const AcdfLocal& local, u32 tree_units, std::size_t most_bytes,
                                   const AcdfAllocator& allocator, AcdfBlock& block) noexcept {
    const AcdfEnvironment& env = local.environment;
    const bool latlong = env.parameterization == ACDF_PARAM_LATLONG;
    const std::size_t heights = latlong ? whole_lines(2 * (std::size_t{env.rows} + 1)) : 0;
    std::size_t at = sizeof(AcdfLocalTables) / 4;
    TileTablesMaker tiles(local.blend, env.columns, env.rows);
    if (!tiles.make()) return nullptr;
    const std::size_t bright_tiles = whole_lines((std::max(local.bright_tile_count, 1u) + 1) / 2 *
                                                 sizeof(AcdfBrightTilePair) / 4),
                      facets = facet_words(local);
    const std::size_t middles = whole_lines(3 * std::size_t{local.blend.tiles->tile_count});
    std::size_t words = at + tiles.words() + heights + bright_tiles + facets + middles;
    if (4 * words > most_bytes) return nullptr;
    PiecesMaker pieces(local, tree_units, most_bytes - 4 * words);
    const bool small = pieces.make();
    if (small) words += pieces.words();
    std::size_t hearts = tiles.heart_words();
    if (hearts > 0 && (4 * (words + hearts) > most_bytes || !tiles.prepare_hearts())) hearts = 0;
    words += hearts;
    block = take_block(allocator, 4 * words);
    if (!block.data) return nullptr;
    u32* const out = static_cast<u32*>(std::memset(block.data, 0, 4 * words));
    AcdfLocalTables* const tables = new (block.data) AcdfLocalTables();
    tables->words = static_cast<u32>(words);
    tables->octahedral = !latlong;
    at = tiles.place(out, at, tables->tiles);
    for (u32 i = 0; i < local.bright_tile_count; ++i)
        reinterpret_cast<AcdfTileRecord*>(out + tables->tiles.tiles)[local.bright_tiles[i].tile].light =
            static_cast<std::uint16_t>(i + 1);
    tables->bright_tiles = static_cast<u32>(at);
    place_lights(local, reinterpret_cast<AcdfBrightTilePair*>(out + at));
    at += bright_tiles;
    if (facets > 0) {
        tables->facets = static_cast<u32>(at);
        place_facets(local, reinterpret_cast<AcdfFacet*>(out + at));
        at += facets;
    }
    if (latlong) {
        tables->heights = static_cast<u32>(at);
        for (u32 i = 0; i <= env.rows; ++i) reinterpret_cast<double*>(out + at)[i] = acdf_row_z(i, env.rows);
        at += heights;
    }
    tables->middles = static_cast<u32>(at);
    place_middles(local, *tables, reinterpret_cast<float*>(out + at));
    at += middles;
    if (hearts > 0) {
        tables->hearts = static_cast<u32>(at);
        tiles.place_hearts(reinterpret_cast<std::uint16_t*>(out + at));
        at += hearts;
    }
    if (small) pieces.place(out, at, *tables);
    return tables;
}

} // namespace acdf
