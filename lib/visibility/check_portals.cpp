// Rectangles that light comes through: PORT. Linear in its bytes.
#include "visibility/check.h"

#include <cmath>

namespace acdf {

namespace {

u64 maps_at(const AcdfPortals& h) { return sizeof h + u64{h.portal_count} * sizeof(AcdfPortal); }
u64 sums_at(const AcdfPortals& h) { return maps_at(h) + u64{h.map_count} * sizeof(AcdfPortalMap); }
u64 corners_of(const AcdfPortals& h) { return (u64{h.size} + 1) * (u64{h.size} + 1); }
u64 rows_at(const AcdfPortals& h) { return sums_at(h) + h.map_count * corners_of(h) * sizeof(u32); }

bool check_portal_size(const Payload& payload, u32 rows, Report& report) {
    if (payload.size < sizeof(AcdfPortals)) {
        report.add(7016, payload.at(0), "PORT has %llu bytes", static_cast<ull>(payload.size));
        return false;
    }
    const AcdfPortals& h = *reinterpret_cast<const AcdfPortals*>(payload.data);
    if (h.portal_count < 1 || h.portal_count > ACDF_MAX_PORTALS || h.map_count < 1 ||
        h.map_count > h.portal_count || h.size < 1 || h.size > ACDF_MAX_PORTAL_CELLS || h.pieces < 1 ||
        h.pieces > ACDF_MAX_PORTAL_PIECES) {
        report.add(7016, payload.at(0), "PORT has %u portals, %u maps of %u cells a side, %u pieces a side",
                   h.portal_count, h.map_count, h.size, h.pieces);
        return false;
    }
    const u64 size = rows_at(h) + u64{rows} * (1 + u64{h.portal_count} * h.pieces * h.pieces);
    if (payload.size != size)
        report.add(7016, payload.at(0), "PORT has %llu bytes instead of %llu", static_cast<ull>(payload.size),
                   static_cast<ull>(size));
    return payload.size == size;
}

bool is_portal(const AcdfPortal& portal, u32 maps) {
    for (const float x : portal.corner)
        if (!std::isfinite(x)) return false;
    for (const float side : portal.sides)
        if (!(std::isfinite(side) && side > 0.0f)) return false;
    return portal.map < maps;
}

bool is_map(const AcdfPortalMap& map) {
    constexpr double most = 1e-4; // what floats are rounded by is far less
    for (int i = 0; i < 3; ++i)
        for (int k = i; k < 3; ++k) {
            double dot = i == k ? -1.0 : 0.0;
            for (int c = 0; c < 3; ++c)
                dot += static_cast<double>(map.axis[i][c]) * static_cast<double>(map.axis[k][c]);
            if (!(std::fabs(dot) <= most)) return false;
        }
    return std::isfinite(map.unit) && map.unit > 0.0f;
}

// Whether each row's share of a cell is no less than the row's below it.
bool are_sums(const u32* sums, u32 size) {
    const u64 width = u64{size} + 1;
    for (u64 i = 0; i < width; ++i)
        if (sums[i] != 0 || sums[i * width] != 0) return false;
    for (u64 row = 1; row < width; ++row)
        for (u64 column = 1; column < width; ++column) {
            const u32 *const now = sums + row * width + column, *const below = now - width;
            // in 64 bits: what a cell has, and its row up to it, must not be below 0
            if (u64{now[0]} + below[-1] < u64{below[0]} + now[-1] || now[0] < now[-1]) return false;
        }
    return true;
}

} // namespace

void check_portals(const Payload& payload, u32 rows, Report& report, AcdfPortalTable& out) noexcept {
    if (!check_portal_size(payload, rows, report)) return;
    const auto* header = reinterpret_cast<const AcdfPortals*>(payload.data);
    const auto* portals = reinterpret_cast<const AcdfPortal*>(header + 1);
    const auto* maps = reinterpret_cast<const AcdfPortalMap*>(portals + header->portal_count);
    const auto* sums = reinterpret_cast<const u32*>(maps + header->map_count);
    bool right = true;
    for (u32 i = 0; i < header->portal_count; ++i)
        if (!is_portal(portals[i], header->map_count)) {
            report.add(7017, payload.at(sizeof *header + u64{i} * sizeof *portals),
                       "portal %u has a corner or side out of range, or no such map", i);
            right = false;
        }
    for (u32 i = 0; i < header->map_count; ++i) {
        const u64 first = i * corners_of(*header);
        if (!is_map(maps[i])) {
            report.add(7018, payload.at(maps_at(*header) + u64{i} * sizeof *maps),
                       "map %u of portals has axes that are not orthonormal, or a unit out of range", i);
            right = false;
        }
        if (!are_sums(sums + first, header->size)) {
            report.add(7019, payload.at(sums_at(*header) + first * sizeof *sums),
                       "map %u of portals has cells of less than nothing", i);
            right = false;
        }
    }
    if (right) out = {header, portals, maps, sums, payload.data + rows_at(*header)};
}

} // namespace acdf
