#include "indexed/check.h"

#include "reader/check/top.h"

#include <cmath>

namespace acdf {

namespace {

constexpr u32 most_map_steps = 65536; // of an indexed axis

// False where MAPS cannot be read by them.
bool check_map_axes(const Payload& payload, Report& report, const Parts& parts) {
    const AcdfDescription& d = *parts.description;
    const u64 at = payload.at(offsetof(AcdfDescription, axis_count));
    if (d.axis_count < 3 || d.axis_count > 2 + ACDF_MOST_INDEXED_AXES) {
        report.add(7020, at, "`axis_count` is %u, not 3 to %u", d.axis_count, 2u + ACDF_MOST_INDEXED_AXES);
        return false;
    }
    u64 bins = 1;
    for (u32 i = 2; i < d.axis_count; ++i) {
        const AcdfAxis& axis = parts.axes[i];
        if (axis.role != ACDF_AXIS_INDEXED || axis.measure != ACDF_MEASURE_LINEAR || axis.resolution < 2 ||
            axis.resolution > most_map_steps) {
            report.add(7020, payload.at(sizeof d + i * sizeof axis),
                       "axis %u of maps: role %u, measure %u, %u steps", i, axis.role, axis.measure,
                       axis.resolution);
            return false;
        }
        bins *= axis.resolution;
    }
    if (bins != d.bin_count)
        report.add(7020, at, "`bin_count` is %u, the axes of maps make %llu", d.bin_count, static_cast<ull>(bins));
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
        report.add(6036, payload.at(0), "MAPS has %u maps, %u splits, codes of %u bits, sun %u", maps.map_count,
                   maps.split_count, maps.code_bits, maps.sun);
    return right;
}

void check_map_coordinates(const Payload& payload, const double* coordinates, Report& report, const Parts& parts) {
    for (u32 i = 2; i < parts.description->axis_count; ++i) {
        const AcdfAxis& axis = parts.axes[i];
        bool right = coordinates[0] == axis.low && coordinates[axis.resolution - 1] == axis.high;
        for (u32 k = 1; k < axis.resolution; ++k) right = right && coordinates[k] > coordinates[k - 1];
        for (u32 k = 0; k < axis.resolution; ++k) right = right && std::isfinite(coordinates[k]);
        if (!right)
            report.add(7021, payload.at(sizeof(AcdfMapsHeader)),
                       "the coordinates of axis %u do not rise from its low to its high", i);
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
            report.add(7022, payload.at(at + i * sizeof(AcdfMap)),
                       "map %u has a share, or a sun, that is out of range", i);
        sum += static_cast<double>(maps[i].share);
    }
    if (!(std::fabs(sum - 1.0) <= 0x1p-20))
        report.add(7022, payload.at(at), "the shares of maps do not add up to 1");
}

// The codes of maps: those of the top of the tree.
void check_map_splits(const Payload& payload, const MapsLayout& layout, Report& report, const Parts& parts) {
    Bits bits(payload, layout.splits, layout.codes);
    if (!check_top(bits, layout.header.split_count, report, parts)) return;
    const u64 count = layout.header.split_count;
    const u64 used = layout.codes * 8 + layout.header.map_count * count * layout.header.code_bits;
    for (u64 at = used; at < layout.end * 8; ++at)
        if (payload.data[at / 8] >> at % 8 & 1u)
            return report.add(6038, payload.at(at / 8), "bits behind the codes of maps are not 0");
}

} // namespace

void take_parts(const AcdfFile& file, Parts& parts) noexcept {
    static_cast<Contents&>(parts) = file;
    const AcdfHalvedTree* const tree = file.environment.halved;
    if (!tree) return;                                                    // two axes are not sampled: rule 7020
    parts.halvings = const_cast<AcdfHalving*>(acdf_halvings_nodes(tree)); // which are only read
    parts.halving_count = tree->count;
}

Maps check_maps(const AcdfFile& file, const Parts& parts, Report& report) noexcept {
    const Payload &description = file.payloads.of[chunk_description], &payload = file.payloads.of[chunk_maps];
    if (!check_map_axes(description, report, parts) || !parts.halvings || report.stopped()) return {};
    const AcdfMapsHeader& header = *reinterpret_cast<const AcdfMapsHeader*>(payload.data);
    if (payload.size < sizeof header) {
        report.add(6036, payload.at(0), "MAPS has %llu bytes, its header %u", static_cast<ull>(payload.size),
                   static_cast<u32>(sizeof header));
        return {};
    }
    if (!check_map_counts(payload, header, report, parts)) return {};
    const MapsLayout layout(header, parts);
    if (payload.size != layout.end) {
        report.add(6036, payload.at(0), "MAPS has %llu bytes instead of %llu", static_cast<ull>(payload.size),
                   static_cast<ull>(layout.end));
        return {};
    }
    const Maps maps = {&header, reinterpret_cast<const double*>(payload.data + sizeof header),
                       reinterpret_cast<const AcdfMap*>(payload.data + layout.maps), payload.data + layout.splits};
    check_map_coordinates(payload, maps.coordinates, report, parts);
    check_each_map(payload, layout.maps, maps.maps, header, report);
    if (!report.stopped()) check_map_splits(payload, layout, report, parts);
    return maps;
}

Verdict validate_maps(const File& file, FindingSink sink, void* context) noexcept {
    Report report(sink, context);
    Parts parts;
    take_parts(*file.get(), parts);
    check_maps(*file.get(), parts, report);
    return report.verdict();
}

} // namespace acdf
