#if ACDF_BATCH_X86
#define ACDF_WIDTH 4
#include "batch/brdf_view_kernel.h"

void acdf::sample_avx2(const BatchTable& table, const float (*wo)[3], const double (*u)[2], std::size_t count,
                       AcdfDirectionSample* out) {
    for_blocks<Samples>(table, wo, u, count, out);
}
void acdf::pdf_avx2(const BatchTable& table, const float (*wo)[3], const float (*wi)[3], std::size_t count,
                    float* out) {
    for_blocks<ViewPdfs>(table, wo, wi, count, out);
}
void acdf::view_pdf_avx2(const BatchTable& table, const AcdfBrdfView& view, const float (*wi)[3], std::size_t count,
                         float* out) {
    view_pdfs(table, view, wi, count, out);
}
void acdf::view_sample_avx2(const BatchTable& table, const AcdfBrdf& brdf, const AcdfBrdfView& view,
                            const double (*u)[2], std::size_t count, AcdfDirectionSample* out) {
    view_samples(table, brdf, view, u, count, out);
}
#endif
