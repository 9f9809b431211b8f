// What bins share: TILE and ROWS. Linear in their bytes.
#include "check/kinds.h"

#include <cstdlib>

namespace acdf {

TileBoxes::~TileBoxes() { std::free(of); }

namespace {

using u8 = std::uint8_t;
using u32 = std::uint32_t;
using u64 = std::uint64_t;
using ull = unsigned long long;

// A split's part that has not been visited yet.
struct OpenTile {
    u32 node;  // a child as stored
    u32 depth; // splits above it
    TileBox box;
};

struct Tiles {
    const Payload& payload;
    const AcdfTiles& header;
    const AcdfSplit* splits;

    u64 at(u32 split) const { return payload.at(sizeof(AcdfTiles) + u64{split} * sizeof(AcdfSplit)); }
};

bool check_size(const Payload& payload, Report& report) {
    const AcdfTiles& t = *reinterpret_cast<const AcdfTiles*>(payload.data);
    if (payload.size < sizeof(AcdfTiles)) {
        report.add(6020, payload.at(0), "TILE has %llu bytes", static_cast<ull>(payload.size));
        return false;
    }
    if (t.tile_count < 1 || t.tile_count > ACDF_MAX_TILES || (t.root_count != 0 && t.root_count != t.tile_count) ||
        t.reserved != 0) {
        report.add(6020, payload.at(0), "%u tiles, %u roots, `reserved` %u", t.tile_count, t.root_count,
                   t.reserved);
        return false;
    }
    const u64 size = sizeof t + u64{t.tile_count - 1} * sizeof(AcdfSplit) + u64{t.root_count} * sizeof(u32);
    if (payload.size != size)
        report.add(6020, payload.at(0), "TILE has %llu bytes instead of %llu", static_cast<ull>(payload.size),
                   static_cast<ull>(size));
    return payload.size == size;
}

void check_codebook(const Payload& payload, const AcdfTiles& tiles, Report& report) {
    for (u32 i = 0; i < 256; ++i) {
        const u32 value = tiles.codebook[i];
        const bool end_ok = (i != 0 || value == 0) && (i != 255 || value == 65535);
        if (end_ok && (i == 0 || value > tiles.codebook[i - 1])) continue;
        report.add(6021, payload.at(offsetof(AcdfTiles, codebook) + 2 * i), "entry %u is %u", i, value);
        return;
    }
}

// One split: false where it cannot be followed.
bool split_box(const Tiles& tiles, u32 index, const TileBox& box, TileBox part[2], Report& report) {
    const AcdfSplit& split = tiles.splits[index];
    const u32 axis = split.place & 7u, position = split.place >> 3;
    if (axis > 1 || position <= box.low[axis] || position >= box.high[axis]) {
        report.add(6023, tiles.at(index), "split %u: axis %u, position %u", index, axis, position);
        return false;
    }
    part[0] = part[1] = box;
    part[0].high[axis] = part[1].low[axis] = position;
    return true;
}

// Visits the splits in preorder; `open` has room for all of them. True where each is met in its turn, and each
// tile.
bool walk(const Tiles& tiles, const TileBox& whole, OpenTile* open, TileBox* boxes, Report& report) {
    u32 next_split = 0, next_tile = 0, count = 0;
    open[count++] = {tiles.header.tile_count > 1 ? 0 : ACDF_TILE_FLAG, 0, whole};
    while (count > 0) {
        const OpenTile now = open[--count];
        if (now.node & ACDF_TILE_FLAG) {
            if ((now.node & ~ACDF_TILE_FLAG) != next_tile) {
                report.add(6022, tiles.at(0), "tile %u comes where %u is due", now.node & ~ACDF_TILE_FLAG,
                           next_tile);
                return false;
            }
            boxes[next_tile++] = now.box;
            continue;
        }
        if (now.node != next_split) {
            report.add(6022, tiles.at(0), "split %u comes where %u is due", now.node, next_split);
            return false;
        }
        if (next_tile + count + 2 > tiles.header.tile_count) { // each open part holds a tile at least
            report.add(6022, tiles.at(0), "split %u leads to more than %u tiles", next_split,
                       tiles.header.tile_count);
            return false;
        }
        if (now.depth == ACDF_MAX_SPLITS_DEEP) {
            report.add(6022, tiles.at(next_split), "split %u has %u above it", next_split, now.depth);
            return false;
        }
        TileBox part[2];
        if (!split_box(tiles, next_split, now.box, part, report)) return false;
        const AcdfSplit& split = tiles.splits[next_split++];
        open[count++] = {split.child[1], now.depth + 1, part[1]};
        open[count++] = {split.child[0], now.depth + 1, part[0]};
    }
    if (next_tile != tiles.header.tile_count)
        report.add(6022, tiles.at(0), "%u of %u tiles are met", next_tile, tiles.header.tile_count);
    return next_tile == tiles.header.tile_count;
}

bool find_boxes(const Tiles& tiles, const Parts& parts, TileBoxes& boxes, Report& report) {
    if (parts.description->axis_count < 2) return false; // no file with tiles has so few: reported elsewhere
    const TileBox whole{{0, 0}, {parts.axes[0].resolution, parts.axes[1].resolution}};
    const u64 count = tiles.header.tile_count;
    boxes.of = static_cast<TileBox*>(std::malloc(count * sizeof(TileBox)));
    OpenTile* open = static_cast<OpenTile*>(std::malloc((count + 1) * sizeof(OpenTile)));
    bool right = false;
    if (boxes.of && open) right = walk(tiles, whole, open, boxes.of, report);
    else report.add(1003, tiles.payload.at(0), "%llu bytes for tiles", static_cast<ull>(count * sizeof(OpenTile)));
    std::free(open);
    if (!right) {
        std::free(boxes.of);
        boxes.of = nullptr;
    }
    return right;
}

} // namespace

void check_tiles(const Payload& payload, const Payload& rows, Report& report, Parts& parts,
                 TileBoxes& boxes) noexcept {
    if (!payload.data) {
        if (rows.data) report.add(6025, rows.at(0), "there are rows, but no tiles");
        return;
    }
    boxes.given = true;
    if (!check_size(payload, report)) return;
    const AcdfTiles& header = *reinterpret_cast<const AcdfTiles*>(payload.data);
    check_codebook(payload, header, report);
    const Tiles tiles{payload, header, reinterpret_cast<const AcdfSplit*>(payload.data + sizeof header)};
    const u64 size = u64{header.row_count} * (header.tile_count - 1);
    const bool rows_ok = rows.data && rows.size == size;
    if (!rows_ok)
        report.add(6025, rows.data ? rows.at(0) : payload.at(0), "ROWS has %llu bytes instead of %llu",
                   static_cast<ull>(rows.size), static_cast<ull>(size));
    if (report.stopped() || !find_boxes(tiles, parts, boxes, report)) return;
    parts.tiles = &header;
    parts.splits = tiles.splits;
    parts.rows = rows_ok ? rows.data : nullptr;
    if (header.root_count == 0) return;
    parts.tile_roots = reinterpret_cast<const u32*>(tiles.splits + (header.tile_count - 1));
    const u64 at = sizeof header + u64{header.tile_count - 1} * sizeof(AcdfSplit);
    boxes.roots = {payload.data + at, payload.size - at, payload.at(at), payload.inflated};
}

} // namespace acdf
