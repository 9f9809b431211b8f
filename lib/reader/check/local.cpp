// What a local environment asks of axes and bins, and its chunk LOCL.
#include "check/kinds.h"

#include <cstring>

namespace acdf {

namespace {

constexpr u32 max_subdivisions = 1024;

// An octahedron's corners: 4 n^2 + 2 of them.
const char* octahedral_fault(const AcdfAxis& axis) {
    const WantedAxis wanted = {"normal", ACDF_AXIS_INDEXED,       ACDF_MEASURE_LINEAR,
                               0.0,      double(axis.resolution), axis.resolution};
    if (const char* fault = axis_fault(axis, wanted)) return fault;
    for (u32 n = 1; n <= max_subdivisions; ++n)
        if (axis.resolution == 4 * n * n + 2) return nullptr;
    return "resolution";
}

} // namespace

void check_local_axes(const Payload& payload, Report& report, const Parts& parts) noexcept {
    const AcdfDescription& d = *parts.description;
    if (d.axis_count != 3) {
        report.add(7003, payload.at(offsetof(AcdfDescription, axis_count)), "a local environment with %u axes",
                   d.axis_count);
        return;
    }
    check_environment_axes(payload, report, parts);
    const AcdfAxis& normals = parts.axes[2];
    if (const char* fault = octahedral_fault(normals))
        report.add(7003, payload.at(sizeof d + 2 * sizeof normals), "axis 2 is not one of normals: the %s differs",
                   fault);
    if (d.bin_count != 0) check_bin_count(payload, 7004, normals.resolution, report, parts); // 0: rule 5007
}

void check_local_header(const Payload& description, const Payload& payload, Report& report, Parts& parts) noexcept {
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
        report.add(7005, payload.at(0), "`cosine_share` is not in [0, 1)");
    if (header->reserved != 0)
        report.add(7005, payload.at(offsetof(AcdfLocalHeader, reserved)), "`reserved` of LOCL is not zero");
    parts.local = header;
}

} // namespace acdf
