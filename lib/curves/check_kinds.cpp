// What kinds ask of files that have curves.
#include "check/kinds.h"
#include "curves/check_tree.h"
#include "curves/functions.h"

#include <acdf/layout.h>

namespace acdf {

namespace {

constexpr WantedAxis grid_axes[2] = {
    {"normal theta", ACDF_AXIS_INDEXED, ACDF_MEASURE_LINEAR, 0.0, ACDF_PI, 65536},
    {"normal phi", ACDF_AXIS_INDEXED, ACDF_MEASURE_LINEAR, ACDF_PI, -ACDF_PI, 65536},
};

// Of a local environment whose normals are cells of a lat-long grid.
void check_grid_axes(const Payload& payload, Report& report, const Parts& parts) {
    const AcdfDescription& d = *parts.description;
    check_environment_axes(payload, report, parts);
    u64 bins = 1;
    for (u32 i = 2; i < 4; ++i) {
        const AcdfAxis& axis = parts.axes[i];
        if (const char* fault = axis_fault(axis, grid_axes[i - 2]))
            report.add(7003, payload.at(sizeof d + i * sizeof axis),
                       "axis %u is not one of normals: the %s differs", i, fault);
        bins *= axis.resolution;
    }
    if (d.bin_count != 0) check_bin_count(payload, 7004, bins, report, parts); // 0: rule 5007
}

// Beside BINS and TREE, what a local environment has.
void check_local(const Payloads& payloads, Report& report, Parts& parts) {
    const Payload& description = payloads.of[chunk_description];
    if (parts.description->axis_count == 4) check_grid_axes(description, report, parts);
    else check_local_axes(description, report, parts);
    check_local_header(description, payloads.of[chunk_local], report, parts);
}

constexpr WantedAxis half_rows = {"cos_theta_h", ACDF_AXIS_SAMPLED, ACDF_MEASURE_LINEAR, 1.0, 0.0, 1u << 28};

} // namespace

void check_curves(const AcdfUncheckedFile* file) {
    const Payloads& payloads = file->payloads;
    const Payload &description = payloads.of[chunk_description], &bins = payloads.of[chunk_bins];
    check_tree(bins, payloads.of[chunk_tree], file->kind, file->report, file->parts);
    if (file->report.stopped()) return;
    if (file->kind == ACDF_KIND_ENVIRONMENT) check_environment(description, bins, file->report, file->parts);
    if (file->kind == ACDF_KIND_LOCAL) check_local(payloads, file->report, file->parts);
    if (file->kind == ACDF_KIND_BRDF) check_brdf_kind(payloads, half_rows, file->report, file->parts);
}

} // namespace acdf
