// Chunk BINS.
#include "check/kinds.h"

#include <cmath>

namespace acdf {

bool check_bins(const Payload& payload, Report& report, Parts& parts) noexcept {
    const u32 count = parts.description->bin_count;
    if (payload.size != u64{count} * sizeof(AcdfBin)) {
        report.add(4004, payload.at(0), "BINS has %llu bytes for %u bins", static_cast<ull>(payload.size), count);
        return false;
    }
    parts.bins = reinterpret_cast<const AcdfBin*>(payload.data);
    bool right = true;
    for (u32 i = 0; i < count && !report.stopped(); ++i) {
        const float share = parts.bins[i].share;
        if (share >= 0.0f && std::isfinite(share)) continue;
        right = false;
        report.add(6017, payload.at(i * sizeof(AcdfBin) + offsetof(AcdfBin, share)),
                   "the share of bin %u is negative or not finite", i);
    }
    return right;
}

void check_bin_count(const Payload& payload, int rule, u64 bins, Report& report, const Parts& parts) noexcept {
    if (bins != parts.description->bin_count)
        report.add(rule, payload.at(offsetof(AcdfDescription, bin_count)), "%u bins, but the axes make %llu",
                   parts.description->bin_count, static_cast<ull>(bins));
}

} // namespace acdf
