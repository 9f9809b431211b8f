// What a table asks of its axes and bins.
#include "check/kinds.h"

#include <acdf/table.h>

#include <cmath>

namespace acdf {

namespace {

// Leaves parts.bins null where shares do not say which bins have trees.
void check_table_bins(const Payload& payload, Report& report, Parts& parts) {
    const u32 count = parts.description->bin_count;
    double sum = 0.0;
    if (!check_bins(payload, report, parts)) {
        parts.bins = nullptr;
        return;
    }
    for (u32 i = 0; i < count; ++i) sum += static_cast<double>(parts.bins[i].share);
    if (!(std::fabs(sum - 1.0) <= 0x1p-20))
        report.add(9005, payload.at(0), "the shares of the bins do not add up to 1");
}

void check_table_weights(const Payload& payload, Report& report, const AcdfDescription& d) {
    const double* w = d.channel_weights;
    if (d.channels == ACDF_CHANNELS_WEIGHTED && w[0] == 1.0 && w[1] == 0.0 && w[2] == 0.0) return;
    if (d.channels > ACDF_CHANNELS_LARGEST) return; // rule 5019
    for (u32 i = 0; i < 3; ++i)
        if (!std::isfinite(w[i]) || w[i] < 0.0) return; // rule 5009
    report.add(9006, payload.at(offsetof(AcdfDescription, channels)),
               "a table whose channels or channel weights are not 0 and 1, 0, 0");
}

void check_table_axes(const Payload& payload, Report& report, const Parts& parts) {
    const AcdfDescription& d = *parts.description;
    if (d.parameterization != ACDF_PARAM_TABLE) return; // rule 5016: what the axes mean is open
    u64 bins = 1;                                       // no more than 2^32: then it is wrong anyway
    bool sampled = false;
    for (u32 i = 0; i < d.axis_count; ++i) {
        const AcdfAxis& axis = parts.axes[i];
        const u64 at = payload.at(sizeof d + i * sizeof axis);
        if (axis.measure == ACDF_MEASURE_COSINE || axis.measure == ACDF_MEASURE_HALF)
            report.add(9001, at + offsetof(AcdfAxis, measure), "axis %u of a table is of measure %u", i,
                       axis.measure);
        if (axis.role == ACDF_AXIS_INDEXED) {
            if (sampled)
                report.add(9002, at + offsetof(AcdfAxis, role), "axis %u is indexed, the one before is not", i);
            if (bins <= 0xFFFFFFFFu) bins *= axis.resolution;
        }
        sampled = sampled || axis.role == ACDF_AXIS_SAMPLED;
        const bool range = std::isfinite(axis.low) && std::isfinite(axis.high) && axis.low != axis.high;
        if (range && axis.resolution >= 1 && axis.resolution <= most_steps && !acdf_table_axis_steps(&axis))
            report.add(9004, at + offsetof(AcdfAxis, low),
                       "the steps of axis %u are too small or its ends too large", i);
    }
    if (bins != 0) check_bin_count(payload, 9003, bins, report, parts); // 0: rule 5014
}

} // namespace

void check_table_kind(const Payloads& payloads, Report& report, const AcdfAllocator& allocator,
                      Parts& parts) noexcept {
    const Payload &description = payloads.of[chunk_description], &bins = payloads.of[chunk_bins];
    check_table_axes(description, report, parts);
    check_table_weights(description, report, *parts.description);
    if (bins.data && !report.stopped()) check_table_bins(bins, report, parts); // else rule 3004
    if (parts.bins && !report.stopped())
        check_halvings(payloads.of[chunk_halvings], &bins, report, allocator, parts);
}

} // namespace acdf
