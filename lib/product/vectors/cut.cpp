// Which loops serve products.
#include "product/vectors/cut.h"

#include "batch/instructions.h"

namespace acdf {

#if ACDF_BATCH_X86
namespace {

template <Instructions most>
void brdf_sample(const AcdfBrdf* brdf, const AcdfBrdfView* view, const double (*u)[2], std::size_t count,
                 AcdfDirectionSample* out) {
    brdf_sample_batch(*brdf, *view, u, count, out, most);
}

template <Instructions most>
void brdf_pdf(const AcdfBrdf* brdf, const AcdfBrdfView* view, const float (*wi)[3], std::size_t count, float* out) {
    brdf_pdf_batch(*brdf, *view, wi, count, out, most);
}

} // namespace
#endif

const AcdfProductVectors* product_vectors(Instructions most) noexcept {
#if ACDF_BATCH_X86
    static constexpr AcdfProductVectors avx2 = {cut_sample_avx2,
                                                cut_pdf_avx2,
                                                fast_cut_sample_avx2,
                                                fast_cut_pdf_avx2,
                                                brdf_sample<Instructions::avx2>,
                                                brdf_pdf<Instructions::avx2>};
    static constexpr AcdfProductVectors avx512 = {cut_sample_avx512,
                                                  cut_pdf_avx512,
                                                  fast_cut_sample_avx512,
                                                  fast_cut_pdf_avx512,
                                                  brdf_sample<Instructions::avx512>,
                                                  brdf_pdf<Instructions::avx512>};
    return best_of<const AcdfProductVectors*>(most, nullptr, &avx2, &avx512);
#else
    (void)most;
    return nullptr;
#endif
}

} // namespace acdf

const AcdfProductVectors* acdf_product_vectors() { return acdf::product_vectors(); }
