// What kinds ask of files that have curves.
#include "check/kinds.h"

namespace acdf {

namespace {

// Beside BINS and TREE, what a local environment has.
void check_local(const Payloads& payloads, Report& report, Parts& parts) {
    check_local_kind(payloads.of[chunk_description], payloads.of[chunk_local], report, parts);
    if (!report.stopped()) check_seen(payloads, report, parts);
}

} // namespace

void check_kind(const Payloads& payloads, std::uint32_t kind, Report& report, Parts& parts) noexcept {
    const Payload &description = payloads.of[chunk_description], &bins = payloads.of[chunk_bins];
    check_tree(bins, payloads.of[chunk_tree], kind, report, parts);
    if (report.stopped()) return;
    if (kind == ACDF_KIND_ENVIRONMENT) check_environment(description, bins, report, parts);
    if (kind == ACDF_KIND_LOCAL) check_local(payloads, report, parts);
    if (kind == ACDF_KIND_BRDF) check_brdf_kind(payloads, report, parts);
}

} // namespace acdf
