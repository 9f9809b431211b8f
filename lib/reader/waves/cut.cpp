// Which loops serve products.
#include "waves/cut.h"

#include "instructions.h"

namespace acdf {

const AcdfLocalVectors* local_vectors(Instructions most) noexcept {
#if ACDF_WAVEFRONT_X86
    static constexpr AcdfLocalVectors avx2 = {cut_sample_avx2, cut_pdf_avx2, fast_cut_sample_avx2,
                                              fast_cut_pdf_avx2};
    static constexpr AcdfLocalVectors avx512 = {cut_sample_avx512, cut_pdf_avx512, fast_cut_sample_avx512,
                                                fast_cut_pdf_avx512};
    return best_of<const AcdfLocalVectors*>(most, nullptr, &avx2, &avx512);
#else
    (void)most;
    return nullptr;
#endif
}

} // namespace acdf
