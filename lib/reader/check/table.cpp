// What a table asks of its axes and bins.
#include "check/kinds.h"

#include <acdf/table.h>

#include <cmath>

namespace acdf {

namespace {

using u32 = std::uint32_t;
using u64 = std::uint64_t;
using ull = unsigned long long;

constexpr u32 most_steps = 0x7FFFFFFF; // rule 5014

void check_table_shares(const Payload& bins, Report& report, const Parts& parts) {
    double sum = 0.0;
    for (u32 i = 0; parts.bins && i < parts.description->bin_count; ++i) {
        if (!(parts.bins[i].share >= 0.0f)) return; // rule 6017
        sum += static_cast<double>(parts.bins[i].share);
    }
    if (parts.bins && std::isfinite(sum) && !(std::fabs(sum - 1.0) <= 0x1p-20))
        report.add(9005, bins.at(0), "their sum is %.9g", sum);
}

void check_table_weights(const Payload& payload, Report& report, const AcdfDescription& d) {
    const double* w = d.channel_weights;
    if (d.channels == ACDF_CHANNELS_WEIGHTED && w[0] == 1.0 && w[1] == 0.0 && w[2] == 0.0) return;
    if (d.channels > ACDF_CHANNELS_LARGEST) return; // rule 5019
    for (u32 i = 0; i < 3; ++i)
        if (!std::isfinite(w[i]) || w[i] < 0.0) return; // rule 5009
    report.add(9006, payload.at(offsetof(AcdfDescription, channels)), "channels %u, weights %g, %g, %g", d.channels,
               w[0], w[1], w[2]);
}

} // namespace

void check_table_kind(const Payload& payload, const Payload& bin_records, Report& report,
                      const Parts& parts) noexcept {
    const AcdfDescription& d = *parts.description;
    if (d.parameterization != ACDF_PARAM_TABLE) return; // rule 5016: what the axes mean is open
    u64 bins = 1;                                       // no more than 2^32: then it is wrong anyway
    bool sampled = false;
    for (u32 i = 0; i < d.axis_count; ++i) {
        const AcdfAxis& axis = parts.axes[i];
        const u64 at = payload.at(sizeof d + i * sizeof axis);
        if (axis.measure == ACDF_MEASURE_COSINE || axis.measure == ACDF_MEASURE_HALF)
            report.add(9001, at + offsetof(AcdfAxis, measure), "axis %u: it is %u", i, axis.measure);
        if (axis.role == ACDF_AXIS_INDEXED) {
            if (sampled)
                report.add(9002, at + offsetof(AcdfAxis, role), "axis %u is indexed, the one before is not", i);
            if (bins <= 0xFFFFFFFFu) bins *= axis.resolution;
        }
        sampled = sampled || axis.role == ACDF_AXIS_SAMPLED;
        const bool range = std::isfinite(axis.low) && std::isfinite(axis.high) && axis.low != axis.high;
        if (range && axis.resolution >= 1 && axis.resolution <= most_steps && !acdf_table_axis_steps(&axis))
            report.add(9004, at + offsetof(AcdfAxis, low), "axis %u: %u steps from %g to %g", i, axis.resolution,
                       axis.low, axis.high);
    }
    check_table_weights(payload, report, d);
    check_table_shares(bin_records, report, parts);
    if (bins != d.bin_count && bins != 0) // 0: rule 5014
        report.add(9003, payload.at(offsetof(AcdfDescription, bin_count)), "it has %u bins, its axes make %llu",
                   d.bin_count, static_cast<ull>(bins));
}

} // namespace acdf
