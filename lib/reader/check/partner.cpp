// Chunk COMP: what a file is made to be combined with.
#include "check/checker.h"

#include <cmath>

namespace acdf {
namespace {

bool is_share(float share) { return share > 0.0f && share <= 1.0f; }

// What is wrong with what stands before the records; null if nothing.
const char* header_fault(const Payload& payload, u32 kind, u32 bins) {
    if (payload.size < sizeof(AcdfPartner)) return "it ends early";
    const AcdfPartner& partner = *reinterpret_cast<const AcdfPartner*>(payload.data);
    const u64 count = partner.record_count;
    if (payload.size != sizeof partner + count * sizeof(AcdfPartnerRecord)) return "its length differs";
    if (count != bins && (count != 0 || kind == ACDF_KIND_LOCAL)) return "there are not as many records as bins";
    if (partner.reserved != 0) return "`reserved` is not zero";
    if (!(partner.share < 1.0f) || !is_share(partner.share)) return "`share` is not in (0, 1)";
    return is_share(partner.recommended_light_share) ? nullptr : "`recommended_light_share` is not in (0, 1]";
}

} // namespace

void check_partner(const Payload& payload, u32 kind, Report& report, Parts& parts) noexcept {
    if (const char* fault = header_fault(payload, kind, parts.description->bin_count)) {
        report.add(5020, payload.at(0), "COMP: %s", fault);
        return;
    }
    const auto* partner = reinterpret_cast<const AcdfPartner*>(payload.data);
    const bool table = kind == ACDF_KIND_TABLE;
    if (partner->kind < ACDF_PARTNER_COSINE || partner->kind > ACDF_PARTNER_TABLE ||
        (partner->kind == ACDF_PARTNER_TABLE) != table)
        report.add(5021, payload.at(0), "an MIS partner of kind %u", partner->kind);
    if (partner->heuristic > ACDF_HEURISTIC_POWER)
        report.add(5021, payload.at(offsetof(AcdfPartner, heuristic)), "an MIS heuristic of number %u",
                   partner->heuristic);
    const auto* records = reinterpret_cast<const AcdfPartnerRecord*>(partner + 1);
    for (u32 i = 0; i < partner->record_count && !report.stopped(); ++i) {
        const AcdfPartnerRecord& r = records[i];
        if (is_share(r.recommended_light_share) && r.flux >= 0.0f && std::isfinite(r.flux) &&
            (r.flux == 0.0f || kind == ACDF_KIND_LOCAL))
            continue;
        report.add(5020, payload.at(sizeof *partner + i * sizeof r),
                   "record %u of COMP has a share or a flux out of range", i);
    }
    parts.partner = partner;
}

} // namespace acdf
