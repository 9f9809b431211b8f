// What a local environment asks of axes and bins, and its chunk LOCL.
#include "check/kinds.h"

#include <cstring>

namespace acdf {

namespace {

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

} // namespace

void check_local_kind(const Payload& description, const Payload& payload, Report& report, Parts& parts) noexcept {
    check_local_axes(description, report, parts);
    const auto* header = reinterpret_cast<const AcdfLocalHeader*>(payload.data);
    if (!payload.data) {
        report.add(7005, description.at(0), "LOCL is missing");
        return;
    }
    if (payload.size != sizeof *header) {
        report.add(7005, payload.at(0), "LOCL has %llu bytes", static_cast<ull>(payload.size));
        return;
    }
    if (!(header->cosine_share >= 0.0f && header->cosine_share < 1.0f))
        report.add(7005, payload.at(0), "`cosine_share` is %g", static_cast<double>(header->cosine_share));
    if (header->reserved != 0)
        report.add(7005, payload.at(offsetof(AcdfLocalHeader, reserved)), "`reserved` is %u", header->reserved);
    parts.local = header;
}

} // namespace acdf
