#if ACDF_BATCH_X86
#define ACDF_WIDTH 8
#include "product/vectors/cut.h"
#include "product/vectors/fast_cut_kernel.h"

void acdf::fast_cut_sample_avx512(const AcdfLocal* local, const AcdfLocalPoint* point, const AcdfFastCut* cut,
                                  const double (*u)[2], std::size_t count, AcdfDirectionSample* out) {
    sample_all_of_cut(*local, *point, *cut, u, count, out);
}
void acdf::fast_cut_pdf_avx512(const AcdfLocal* local, const AcdfLocalPoint* point, const AcdfFastCut* cut,
                               const float (*directions)[3], std::size_t count, float* out) {
    pdf_all_of_cut(*local, *point, *cut, directions, count, out);
}
#endif
