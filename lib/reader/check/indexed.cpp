// Indexed environments: chunk MAPS, and the axes of maps.
#include "check/kinds.h"
#include "check/top.h"

#include <cmath>

namespace acdf {

namespace {

constexpr u32 most_map_steps = 65536; // of an indexed axis

// False where MAPS cannot be read by them.
bool check_map_axes(const Payload& payload, Report& report, const Parts& parts) {
    const AcdfDescription& d = *parts.description;
    const u64 at = payload.at(offsetof(AcdfDescription, axis_count));
    if (d.axis_count < 3 || d.axis_count > 2 + ACDF_MOST_INDEXED_AXES) {
        report.add(7020, at, "it has %u axes", d.axis_count);
        return false;
    }
    u64 bins = 1;
    for (u32 i = 2; i < d.axis_count; ++i) {
        const AcdfAxis& axis = parts.axes[i];
        if (axis.role != ACDF_AXIS_INDEXED || axis.measure != ACDF_MEASURE_LINEAR || axis.resolution < 2 ||
            axis.resolution > most_map_steps) {
            report.add(7020, payload.at(sizeof d + i * sizeof axis), "axis %u: role %u, measure %u, %u steps", i,
                       axis.role, axis.measure, axis.resolution);
            return false;
        }
        bins *= axis.resolution;
    }
    if (bins != d.bin_count) report.add(7020, at, "it has %u bins, not %llu", d.bin_count, static_cast<ull>(bins));
    return bins == d.bin_count;
}

// The counts of MAPS, and where its parts begin.
struct MapsLayout {
    const AcdfMapsHeader& header;
    u64 coordinates = 0, maps, splits, codes, end;

    MapsLayout(const AcdfMapsHeader& of, const Parts& parts) : header(of) {
        for (u32 i = 2; i < parts.description->axis_count; ++i) coordinates += parts.axes[i].resolution;
        maps = sizeof header + 8 * coordinates;
        splits = maps + u64{header.map_count} * sizeof(AcdfMap);
        codes = splits + 4 * words_for(parts.halving_count);
        end = codes + 4 * words_for(u64{header.map_count} * header.split_count * header.code_bits);
    }
};

bool check_map_counts(const Payload& payload, const AcdfMapsHeader& maps, Report& report, const Parts& parts) {
    // Fewer than 2^32 maps of 24 bytes and 2^27 splits of at least 4 bits: nothing below overflows.
    const bool right = maps.map_count == parts.description->bin_count && maps.split_count <= parts.halving_count &&
                       maps.code_bits >= ACDF_LEAST_MAP_CODE_BITS && maps.code_bits <= ACDF_MOST_CODE_BITS &&
                       maps.sun <= ACDF_MOST_SUN;
    if (!right)
        report.add(6036, payload.at(0), "%u maps, %u splits, codes of %u bits, sun %u", maps.map_count,
                   maps.split_count, maps.code_bits, maps.sun);
    return right;
}

void check_map_coordinates(const Payload& payload, const double* coordinates, Report& report, const Parts& parts) {
    for (u32 i = 2; i < parts.description->axis_count; ++i) {
        const AcdfAxis& axis = parts.axes[i];
        bool right = coordinates[0] == axis.low && coordinates[axis.resolution - 1] == axis.high;
        for (u32 k = 1; k < axis.resolution; ++k) right = right && coordinates[k] > coordinates[k - 1];
        for (u32 k = 0; k < axis.resolution; ++k) right = right && std::isfinite(coordinates[k]);
        if (!right) report.add(7021, payload.at(sizeof(AcdfMapsHeader)), "axis %u", i);
        coordinates += axis.resolution;
    }
}

bool is_right_map(const AcdfMap& map, bool sun) {
    double length = 0.0;
    for (const float x : map.sun) length += double{x} * double{x};
    const bool known = map.radius > 0.0f;
    return std::isfinite(map.share) && map.share > 0.0f && map.sun_share >= 0.0f && map.sun_share < 1.0f &&
           (!known || (map.radius >= 0x1p-10f && map.radius <= 1.0f)) && map.radius >= 0.0f &&
           (known ? std::fabs(length - 1.0) < 1e-3 : length == 0.0) && (map.sun_share == 0.0f || (sun && known));
}

void check_each_map(const Payload& payload, u64 at, const AcdfMap* maps, const AcdfMapsHeader& header,
                    Report& report) {
    double sum = 0.0;
    for (u32 i = 0; i < header.map_count && !report.stopped(); ++i) {
        if (!is_right_map(maps[i], header.sun != 0))
            report.add(7022, payload.at(at + i * sizeof(AcdfMap)), "map %u", i);
        sum += static_cast<double>(maps[i].share);
    }
    if (!(std::fabs(sum - 1.0) <= 0x1p-20)) report.add(7022, payload.at(at), "the shares add up to %.9g", sum);
}

// The codes of maps: those of the top of the tree.
void check_map_splits(const Payload& payload, const MapsLayout& layout, Report& report, const Parts& parts) {
    Bits bits(payload, layout.splits, layout.codes);
    if (!check_top(bits, layout.header.split_count, report, parts)) return;
    const u64 count = layout.header.split_count;
    const u64 used = layout.codes * 8 + layout.header.map_count * count * layout.header.code_bits;
    for (u64 at = used; at < layout.end * 8; ++at)
        if (payload.data[at / 8] >> at % 8 & 1u) return report.add(6038, payload.at(at / 8), "behind the codes");
}

} // namespace

void check_indexed(const Payload& description, const Payload& payload, Report& report, Parts& parts) noexcept {
    if (parts.description->axis_count >= 2) check_environment_axes(description, report, parts);
    if (!check_map_axes(description, report, parts) || !payload.data || !parts.halvings || report.stopped()) return;
    const AcdfMapsHeader& maps = *reinterpret_cast<const AcdfMapsHeader*>(payload.data);
    if (payload.size < sizeof maps)
        return report.add(6036, payload.at(0), "%llu bytes", static_cast<ull>(payload.size));
    if (!check_map_counts(payload, maps, report, parts)) return;
    const MapsLayout layout(maps, parts);
    if (payload.size != layout.end)
        return report.add(6036, payload.at(0), "%llu bytes instead of %llu", static_cast<ull>(payload.size),
                          static_cast<ull>(layout.end));
    parts.coordinates = reinterpret_cast<const double*>(payload.data + sizeof maps);
    parts.of_map = reinterpret_cast<const AcdfMap*>(payload.data + layout.maps);
    check_map_coordinates(payload, parts.coordinates, report, parts);
    check_each_map(payload, layout.maps, parts.of_map, maps, report);
    if (!report.stopped()) check_map_splits(payload, layout, report, parts);
    parts.map_splits = payload.data + layout.splits;
    parts.maps = &maps;
}

} // namespace acdf
