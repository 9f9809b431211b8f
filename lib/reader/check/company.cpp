// Chunk COMP: what a file is made to be combined with.
#include "check/checker.h"

#include <cmath>

namespace acdf {
namespace {

using u32 = std::uint32_t;
using u64 = std::uint64_t;

bool is_share(float share) { return share > 0.0f && share <= 1.0f; }

// What is wrong with what stands before the records; null if nothing.
const char* header_fault(const Payload& payload, u32 kind, u32 bins) {
    if (payload.size < sizeof(AcdfCompany)) return "it ends early";
    const AcdfCompany& company = *reinterpret_cast<const AcdfCompany*>(payload.data);
    const u64 count = company.record_count;
    if (payload.size != sizeof company + count * sizeof(AcdfCompanyRecord)) return "its length differs";
    if (count != bins && (count != 0 || kind == ACDF_KIND_LOCAL)) return "there are not as many records as bins";
    if (company.reserved != 0) return "`reserved` is not zero";
    if (!(company.share < 1.0f) || !is_share(company.share)) return "`share` is not in (0, 1)";
    return is_share(company.recommended_share) ? nullptr : "`recommended_share` is not in (0, 1]";
}

} // namespace

void check_company(const Payload& payload, u32 kind, Report& report, Parts& parts) noexcept {
    if (const char* fault = header_fault(payload, kind, parts.description->bin_count)) {
        report.add(5020, payload.at(0), "%s", fault);
        return;
    }
    const auto* company = reinterpret_cast<const AcdfCompany*>(payload.data);
    const bool table = kind == ACDF_KIND_TABLE;
    if (company->kind < ACDF_COMPANY_COSINE || company->kind > ACDF_COMPANY_TABLE ||
        (company->kind == ACDF_COMPANY_TABLE) != table)
        report.add(5021, payload.at(0), "a company of kind %u", company->kind);
    if (company->heuristic > ACDF_HEURISTIC_POWER)
        report.add(5021, payload.at(offsetof(AcdfCompany, heuristic)), "heuristic %u", company->heuristic);
    const auto* records = reinterpret_cast<const AcdfCompanyRecord*>(company + 1);
    for (u32 i = 0; i < company->record_count && !report.stopped(); ++i) {
        const AcdfCompanyRecord& r = records[i];
        if (is_share(r.recommended_share) && r.flux >= 0.0f && std::isfinite(r.flux) &&
            (r.flux == 0.0f || kind == ACDF_KIND_LOCAL))
            continue;
        report.add(5020, payload.at(sizeof *company + i * sizeof r), "record %u", i);
    }
    parts.company = company;
}

} // namespace acdf
