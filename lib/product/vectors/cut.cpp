// Which loops serve products.
#include "product/vectors/cut.h"

#include "batch/instructions.h"

namespace acdf {

const AcdfProductVectors* product_vectors(Instructions most) noexcept {
#if ACDF_BATCH_X86
    static constexpr AcdfProductVectors avx2 = {cut_sample_avx2, cut_pdf_avx2, fast_cut_sample_avx2,
                                                fast_cut_pdf_avx2};
    static constexpr AcdfProductVectors avx512 = {cut_sample_avx512, cut_pdf_avx512, fast_cut_sample_avx512,
                                                  fast_cut_pdf_avx512};
    return best_of<const AcdfProductVectors*>(most, nullptr, &avx2, &avx512);
#else
    (void)most;
    return nullptr;
#endif
}

} // namespace acdf

const AcdfProductVectors* acdf_product_vectors() { return acdf::product_vectors(); }
