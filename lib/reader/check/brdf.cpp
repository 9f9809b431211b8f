// What a BRDF asks of axes and bins, and its chunk VIEW.
#include "check/kinds.h"

#include <acdf/brdf_half.h>

#include <cmath>
#include <cstring>

namespace acdf {

namespace {

constexpr u32 max_columns = 1u << 16, max_views = 1u << 16;

constexpr WantedAxis wanted[] = {
    // SPEC.md §11
    {"phi_h", ACDF_AXIS_SAMPLED, ACDF_MEASURE_LINEAR, -ACDF_PI, ACDF_PI, max_columns},
    {"cos_theta_h", ACDF_AXIS_SAMPLED, ACDF_MEASURE_HALF, 1.0, 0.0, ACDF_HALF_ROWS},
    {"theta_o", ACDF_AXIS_INDEXED, ACDF_MEASURE_LINEAR, 0.0, 0.5 * ACDF_PI, max_views},
    {"phi_o", ACDF_AXIS_INDEXED, ACDF_MEASURE_LINEAR, -ACDF_PI, ACDF_PI, max_views},
};

const char* brdf_axis_fault(const AcdfAxis& axis, u32 i, const WantedAxis& rows) {
    WantedAxis own = i == 1 ? rows : wanted[i];
    if (i == 0 && axis.low == 0.0) own.low = 0.0; // mirrored
    const char* fault = axis_fault(axis, own);
    const bool other = own.measure == ACDF_MEASURE_HALF && axis.resolution != ACDF_HALF_ROWS;
    return !fault && other ? "resolution" : fault;
}

void check_brdf_axes(const Payload& payload, const WantedAxis& rows, Report& report, const Parts& parts) {
    const AcdfDescription& d = *parts.description;
    if (d.axis_count != 4) {
        report.add(8001, payload.at(offsetof(AcdfDescription, axis_count)), "a BRDF with %u axes", d.axis_count);
        return;
    }
    for (u32 i = 0; i < 4; ++i)
        if (const char* fault = brdf_axis_fault(parts.axes[i], i, rows))
            report.add(8001, payload.at(sizeof d + i * sizeof(AcdfAxis)),
                       "axis %u is not that of a BRDF: the %s differs", i, fault);
    check_bin_count(payload, 8002, u64{parts.axes[2].resolution} * parts.axes[3].resolution, report, parts);
    for (u32 i = 0; parts.bins && i < d.bin_count; ++i)
        if (parts.bins[i].root == ACDF_NO_ROOT)
            report.add(8006, payload.at(0), "bin %u of a BRDF is not stored", i);
}

const char* views_fault(const Payload& payload, const Parts& parts) {
    if (payload.size < sizeof(AcdfViews)) return "it ends early";
    const AcdfViews& v = *reinterpret_cast<const AcdfViews*>(payload.data);
    if (payload.size != sizeof v + u64{v.theta_count} * sizeof(float)) return "its length differs";
    if (v.theta_count < 1 || v.phi_count < 1) return "there are no views";
    if ((v.flags & ~ACDF_VIEWS_MIRRORED) != 0) return "an unknown flag is set";
    if (parts.description->axis_count != 4) return nullptr; // rule 8001
    if (v.theta_count != parts.axes[2].resolution || v.phi_count != parts.axes[3].resolution)
        return "the axes have other resolutions";
    if ((v.flags & ACDF_VIEWS_MIRRORED) != 0 ? parts.axes[0].low != 0.0 : parts.axes[0].low == 0.0)
        return "the range of phi_h is that of another flag";
    return (v.flags & ACDF_VIEWS_MIRRORED) != 0 && v.phi_count != 1 ? "several azimuths are mirrored" : nullptr;
}

void check_nodes(const Payload& payload, Report& report, const Parts& parts) {
    float before = -1.0f;
    for (u32 i = 0; i < parts.views->theta_count; ++i) {
        const float x = parts.nodes[i];
        if (!(x >= 0.0f && x <= 1.0f && x > before)) {
            report.add(8004, payload.at(sizeof(AcdfViews) + u64{i} * sizeof x),
                       "stored view %u is not above the one before, or not in [0, 1]", i);
            return;
        }
        before = x;
    }
}

} // namespace

void check_brdf_kind(const Payloads& payloads, const WantedAxis& rows, Report& report, Parts& parts) noexcept {
    const Payload &description = payloads.of[chunk_description], &views = payloads.of[chunk_views];
    if (parts.description->parameterization != ACDF_PARAM_HALF_ANGLE) return; // rule 5016: what axes mean is open
    check_brdf_axes(description, rows, report, parts);
    if (!views.data) {
        report.add(8003, description.at(0), "VIEW is missing");
        return;
    }
    if (const char* fault = views_fault(views, parts)) {
        report.add(8003, views.at(0), "VIEW: %s", fault);
        return;
    }
    parts.views = reinterpret_cast<const AcdfViews*>(views.data);
    parts.nodes = reinterpret_cast<const float*>(views.data + sizeof(AcdfViews));
    const float share = parts.views->diffuse_share;
    if (!(share >= 0.0f && share < 1.0f))
        report.add(8005, views.at(offsetof(AcdfViews, diffuse_share)), "`diffuse_share` is not in [0, 1)");
    check_nodes(views, report, parts);
}

void check_halved_brdf(const Payloads& payloads, Report& report, Parts& parts) noexcept {
    check_rows(payloads, report, parts);
    if (!report.stopped()) check_brdf_kind(payloads, wanted[1], report, parts);
}

} // namespace acdf
