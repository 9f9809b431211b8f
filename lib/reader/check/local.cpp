// What a local environment asks of axes and bins, and its chunk LOCL.
#include "check/kinds.h"

#include <cmath>
#include <cstring>

namespace acdf {

namespace {

using u8 = std::uint8_t;
using u32 = std::uint32_t;
using u64 = std::uint64_t;
using ull = unsigned long long;

constexpr u32 max_subdivisions = 1024;

bool named(const AcdfAxis& axis, const char* name) {
    return std::strncmp(reinterpret_cast<const char*>(axis.name), name, sizeof axis.name) == 0;
}

// An octahedron's corners: 4 n^2 + 2 of them.
const char* octahedral_fault(const AcdfAxis& axis) {
    if (!named(axis, "normal")) return "name";
    if (axis.role != ACDF_AXIS_INDEXED) return "role";
    if (axis.measure != ACDF_MEASURE_LINEAR) return "measure";
    if (axis.low != 0.0 || axis.high != axis.resolution) return "range";
    for (u32 n = 1; n <= max_subdivisions; ++n)
        if (axis.resolution == 4 * n * n + 2) return nullptr;
    return "resolution";
}

const char* grid_fault(const AcdfAxis& axis, bool theta) {
    if (!named(axis, theta ? "normal theta" : "normal phi")) return "name";
    if (axis.role != ACDF_AXIS_INDEXED) return "role";
    if (axis.measure != ACDF_MEASURE_LINEAR) return "measure";
    if (axis.low != (theta ? 0.0 : ACDF_PI) || axis.high != (theta ? ACDF_PI : -ACDF_PI)) return "range";
    return axis.resolution > 65536 ? "resolution" : nullptr;
}

void check_local_axes(const Payload& payload, Report& report, const Parts& parts) {
    const AcdfDescription& d = *parts.description;
    if (d.axis_count != 3 && d.axis_count != 4) {
        report.add(7003, payload.at(offsetof(AcdfDescription, axis_count)), "it has %u axes", d.axis_count);
        return;
    }
    check_environment_axes(payload, report, parts);
    u64 bins = 1;
    for (u32 i = 2; i < d.axis_count; ++i) {
        const AcdfAxis& axis = parts.axes[i];
        const char* fault = d.axis_count == 3 ? octahedral_fault(axis) : grid_fault(axis, i == 2);
        if (fault) report.add(7003, payload.at(sizeof d + i * sizeof axis), "axis %u: the %s differs", i, fault);
        bins *= axis.resolution;
    }
    if (bins != d.bin_count && d.bin_count != 0) // 0: rule 5007
        report.add(7004, payload.at(offsetof(AcdfDescription, bin_count)), "it has %u bins, its axes make %llu",
                   d.bin_count, static_cast<ull>(bins));
}

// The fault of a bright tile; null if none.
const char* bright_tile_fault(const AcdfBrightTile& light, const TileBox& box) {
    double square = 0.0;
    for (float x : light.direction) square += static_cast<double>(x) * static_cast<double>(x);
    if (!(std::fabs(square - 1.0) < 1e-3)) return "direction";
    if (!(light.radius > 0.0f && light.radius <= 2.0f)) return "radius";
    if (!(light.share > 0.0f && std::isfinite(light.share))) return "share";
    return std::memcmp(light.low, box.low, sizeof light.low) == 0 &&
                   std::memcmp(light.high, box.high, sizeof light.high) == 0
               ? nullptr
               : "box";
}

void check_bright_tiles(const Payload& payload, const TileBoxes& boxes, Report& report, const Parts& parts) {
    const u32 tiles = boxes.of ? parts.tiles->tile_count : 0;
    for (u32 i = 0; i < parts.local->bright_tile_count && !report.stopped(); ++i) {
        const AcdfBrightTile& light = parts.bright_tiles[i];
        const char* fault = light.tile < tiles && (i == 0 || light.tile > parts.bright_tiles[i - 1].tile)
                                ? bright_tile_fault(light, boxes.of[light.tile])
                                : "tile";
        if (fault)
            report.add(7006, payload.at(sizeof(AcdfLocalHeader) + i * sizeof light), "bright tile %u: its %s", i,
                       fault);
    }
}

// The side of one split that leads to a tile.
struct Step {
    u32 split;
    bool upper;
};

// The splits on the way to the box of a tile; returns how many.
u32 path_to(const AcdfBrightTile& light, const Parts& parts, Step path[ACDF_MAX_SPLITS_DEEP]) {
    u32 count = 0;
    for (u32 node = parts.tiles->tile_count > 1 ? 0 : ACDF_TILE_FLAG; !(node & ACDF_TILE_FLAG);) {
        const AcdfSplit& split = parts.splits[node];
        const bool upper = light.low[split.place & 7u] >= split.place >> 3;
        path[count++] = {node, upper};
        node = split.child[upper];
    }
    return count;
}

// Whether a row gives nothing to a bright tile, by the splits on its path.
struct DarkRows {
    const Parts& parts;
    Step path[ACDF_MAX_SPLITS_DEEP];
    u32 steps;

    DarkRows(const Parts& of, const AcdfBrightTile& light) : parts(of), steps(path_to(light, of, path)) {}
    bool in(u32 row) const {
        const u8* codes = parts.rows + u64{row} * (parts.tiles->tile_count - 1);
        for (u32 s = 0; s < steps; ++s)
            if (codes[path[s].split] == (path[s].upper ? 255 : 0)) return true;
        return false;
    }
};

// Light is sampled as a bright tile or in the mixture, but not both.
void check_bright_tile_rows(const Payload& payload, Report& report, const Parts& parts) {
    const u32 bins = parts.bins ? parts.description->bin_count : 0;
    for (u32 i = 0; i < parts.local->bright_tile_count && !report.stopped(); ++i) {
        const DarkRows dark(parts, parts.bright_tiles[i]);
        for (u32 b = 0; b < bins; ++b) {
            if (parts.bins[b].root >= parts.tiles->row_count || !(parts.bins[b].share > 0.0f)) continue;
            if (dark.in(parts.bins[b].root)) continue;
            report.add(7007, payload.at(sizeof(AcdfLocalHeader) + i * sizeof(AcdfBrightTile)),
                       "bright tile %u in bin %u", i, b);
            break;
        }
    }
}

} // namespace

void check_local_kind(const Payload& description, const Payload& payload, const TileBoxes& boxes, Report& report,
                      Parts& parts) noexcept {
    check_local_axes(description, report, parts);
    const u64 errors = report.verdict().errors;
    const auto* header = reinterpret_cast<const AcdfLocalHeader*>(payload.data);
    if (!payload.data) {
        report.add(7005, description.at(0), "LOCL is missing");
        return;
    }
    if (payload.size < sizeof *header || header->bright_tile_count > ACDF_MAX_BRIGHT_TILES ||
        payload.size != sizeof *header + header->bright_tile_count * sizeof(AcdfBrightTile)) {
        report.add(7005, payload.at(0), "LOCL has %llu bytes", static_cast<ull>(payload.size));
        return;
    }
    if (!(header->cosine_share >= 0.0f && header->cosine_share < 1.0f))
        report.add(7005, payload.at(0), "`cosine_share` is %g", static_cast<double>(header->cosine_share));
    parts.local = header;
    parts.bright_tiles = reinterpret_cast<const AcdfBrightTile*>(payload.data + sizeof *header);
    if (parts.tiles || !boxes.given) check_bright_tiles(payload, boxes, report, parts); // else reported for TILE
    if (report.verdict().errors != errors) return;
    if (parts.rows) check_bright_tile_rows(payload, report, parts);
}

} // namespace acdf
