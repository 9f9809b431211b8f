#if ACDF_BATCH_X86
#define ACDF_WIDTH 8
#include "product/vectors/cut.h"
#include "product/vectors/cut_kernel.h"
#include "product/vectors/cut_pdf_kernel.h"

void acdf::cut_sample_avx512(const AcdfLocal* local, const AcdfLocalPoint* point, const AcdfCut* cut,
                             const double (*u)[2], std::size_t count, AcdfDirectionSample* out) {
    draw_cut(*local, *point, *cut, u, count, out);
}
void acdf::cut_pdf_avx512(const AcdfLocal* local, const AcdfLocalPoint* point, const AcdfCut* cut,
                          const float (*directions)[3], std::size_t count, float* out) {
    cut_pdfs(*local, *point, *cut, directions, count, out);
}
#endif
