/* Files that are not to be used alone: made to be combined, by multiple importance sampling, with another sampler
 * that covers what they leave out (SPEC.md §5.4). Freestanding, valid C99, C++17 and CUDA/HIP/SYCL.
 *
 * Their pdf may be 0 where there is light: a renderer samples from both, and weighs by both pdfs. Such a file
 * stores which share of the samples to take from it. */
#ifndef ACDF_PARTNER_H
#define ACDF_PARTNER_H

#include <acdf/elementary.h>
#include <acdf/layout.h>

#ifdef __cplusplus
extern "C" {
#endif

/* One a bin, or null: `partner` is null where a file is to be used alone, or has none. */
ACDF_FN const AcdfPartnerRecord* acdf_partner_records(const AcdfPartner* partner) {
    return partner && partner->record_count ? (const AcdfPartnerRecord*)(partner + 1) : 0;
}

/* Of the samples, in (0, 1]: 1 where the file is to be used alone. */
ACDF_FN float acdf_partner_share(const AcdfPartner* partner) {
    return partner ? partner->recommended_light_share : 1.0f;
}

/* The same for a bin. */
ACDF_FN float acdf_partner_bin_share(const AcdfPartner* partner, uint32_t bin) {
    const AcdfPartnerRecord* records = acdf_partner_records(partner);
    return records && bin < partner->record_count ? records[bin].recommended_light_share
                                                  : acdf_partner_share(partner);
}

#ifdef __cplusplus
}
#endif
#endif
