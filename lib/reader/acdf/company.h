/* Files that are not to be used alone: made to be combined, by multiple importance sampling, with another sampler
 * that covers what they leave out (SPEC.md §5.8). Freestanding, valid C99, C++17 and CUDA/HIP/SYCL.
 *
 * Their density may be 0 where there is light: a renderer draws from both, weighs by both densities, and asks such
 * a file which share of the samples to draw from it. */
#ifndef ACDF_COMPANY_H
#define ACDF_COMPANY_H

#include <acdf/elementary.h>
#include <acdf/layout.h>

#ifdef __cplusplus
extern "C" {
#endif

/* One a bin, or null: `company` is null where a file is to be used alone, or has none. */
ACDF_FN const AcdfCompanyRecord* acdf_company_records(const AcdfCompany* company) {
    return company && company->record_count ? (const AcdfCompanyRecord*)(company + 1) : 0;
}

/* Of the samples, in (0, 1]: 1 where the file is to be used alone. */
ACDF_FN float acdf_company_share(const AcdfCompany* company) { return company ? company->recommended_share : 1.0f; }

/* The same for a bin. */
ACDF_FN float acdf_company_bin_share(const AcdfCompany* company, uint32_t bin) {
    const AcdfCompanyRecord* records = acdf_company_records(company);
    return records && bin < company->record_count ? records[bin].recommended_share : acdf_company_share(company);
}

#ifdef __cplusplus
}
#endif
#endif
