// The fast shape of local environments: SUMS and GRID. Linear in their bytes.
#include "check/kinds.h"

#include <acdf/fast.h>

namespace acdf {

namespace {

using u8 = std::uint8_t;
using u16 = std::uint16_t;
using u32 = std::uint32_t;
using u64 = std::uint64_t;
using ull = unsigned long long;

// Whether `count` ends never decrease up to the last one, which is `whole`.
template <class Integer>
bool are_ends(const Integer* end, u32 count, u32 whole) {
    u32 before = 0;
    for (u32 i = 0; i < count; ++i) {
        if (end[i] < before) return false;
        before = end[i];
    }
    return before == whole;
}

bool check_sums(const Payload& payload, const AcdfTiles& tiles, Report& report) {
    const u32 groups = acdf_fast_group_count(tiles.tile_count), ends = acdf_fast_ends(tiles.tile_count),
              stride = acdf_fast_stride(tiles.tile_count);
    const u64 tiles_at = u64{2} * tiles.row_count * ends, size = tiles_at + u64{tiles.row_count} * stride;
    if (payload.size != size) {
        report.add(6028, payload.at(0), "SUMS has %llu bytes instead of %llu", static_cast<ull>(payload.size),
                   static_cast<ull>(size));
        return false;
    }
    for (u32 row = 0; row < tiles.row_count; ++row) {
        const u64 at = u64{2} * row * ends;
        const u8* const tile = payload.data + tiles_at + u64{row} * stride;
        const auto* const group = reinterpret_cast<const u16*>(payload.data + at);
        bool right = are_ends(group, ends, ACDF_FAST_WHOLE) && group[groups - 1] == ACDF_FAST_WHOLE;
        for (u32 g = 0; right && g < groups; ++g) {
            const u32 left = tiles.tile_count - ACDF_FAST_GROUP * g;
            const u8* const list = tile + ACDF_FAST_GROUP * g;
            right = are_ends(list, ACDF_FAST_GROUP, 255) && (left > ACDF_FAST_GROUP || list[left - 1] == 255);
        }
        if (right) continue;
        report.add(6028, payload.at(at), "row %u", row);
        return false;
    }
    return true;
}

// What is wrong with the grid of a tile that begins at byte `at`, which moves behind it; null if nothing.
const char* grid_fault(const Payload& payload, const TileBox& box, u64& at) {
    if (payload.size - at < 2) return "begins after the end";
    u32 count[2];
    for (u32 axis = 0; axis < 2; ++axis) {
        const u32 shift = payload.data[at + axis];
        if (shift > ACDF_FAST_MOST_SHIFT) return "has too large a shift";
        count[axis] = acdf_fast_cells(box.high[axis] - box.low[axis], shift);
        if (count[axis] > ACDF_FAST_CELLS) return "has too many cells";
    }
    at += 2;
    if (payload.size - at < count[1] + u64{count[0]} * count[1]) return "ends after the end";
    const u8* list = payload.data + at;
    bool right = are_ends(list, count[1], 255);
    list += count[1];
    for (u32 line = 0; right && line < count[1]; ++line, list += count[0]) right = are_ends(list, count[0], 255);
    at += count[1] + u64{count[0]} * count[1];
    return right ? nullptr : "has sums that decrease or are out of range";
}

bool check_grid(const Payload& payload, const TileBoxes& boxes, const Parts& parts, Report& report) {
    u64 at = 0;
    for (u32 tile = 0; tile < parts.tiles->tile_count; ++tile) {
        if (parts.tile_roots[tile] != at) {
            report.add(6029, boxes.roots.at(u64{tile} * sizeof(u32)), "tile %u: its root is %u instead of %llu",
                       tile, parts.tile_roots[tile], static_cast<ull>(at));
            return false;
        }
        const u64 begin = at;
        if (const char* fault = grid_fault(payload, boxes.of[tile], at)) {
            report.add(6029, payload.at(begin < payload.size ? begin : 0), "the grid of tile %u %s", tile, fault);
            return false;
        }
    }
    bool padded = payload.size - at == ACDF_FAST_CELLS;
    for (u64 i = at; padded && i < payload.size; ++i) padded = payload.data[i] == 0;
    if (!padded)
        report.add(6029, payload.at(0), "%llu bytes follow the last grid", static_cast<ull>(payload.size - at));
    return padded;
}

} // namespace

void check_fast(const Payloads& payloads, const TileBoxes& boxes, Report& report, Parts& parts) noexcept {
    const Payload &sums = payloads.of[chunk_sums], &grid = payloads.of[chunk_grid];
    const Payload& either = sums.data ? sums : grid;
    const bool visibility = payloads.of[chunk_visibility].data || payloads.of[chunk_portals].data;
    if (!sums.data || !grid.data || payloads.of[chunk_rows].data || !payloads.of[chunk_tiles].data || visibility)
        report.add(6027, either.at(0), "%s",
                   !sums.data                       ? "there is GRID, but no SUMS"
                   : !grid.data                     ? "there is SUMS, but no GRID"
                   : payloads.of[chunk_rows].data   ? "there is ROWS, too"
                   : !payloads.of[chunk_tiles].data ? "there are no tiles"
                                                    : "there are visibility cells, too");
    if (!parts.tiles || !boxes.of || !sums.data || !grid.data || report.stopped()) return;
    if (parts.tiles->root_count == 0) {
        report.add(6027, payloads.of[chunk_tiles].at(offsetof(AcdfTiles, root_count)), "tiles have no roots");
        return;
    }
    const bool sums_right = check_sums(sums, *parts.tiles, report);
    if (report.stopped() || !check_grid(grid, boxes, parts, report) || !sums_right) return;
    const u32 count = parts.tiles->tile_count, ends = acdf_fast_ends(count);
    parts.fast.grid = grid.data;
    parts.fast.groups = reinterpret_cast<const u16*>(sums.data);
    parts.fast.tiles = sums.data + u64{2} * parts.tiles->row_count * ends;
    parts.fast.ends = ends;
    parts.fast.stride = acdf_fast_stride(count);
}

} // namespace acdf
