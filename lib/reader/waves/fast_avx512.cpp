#if ACDF_WAVEFRONT_X86
#define ACDF_WIDTH 8
#include "waves/cut.h"
#include "waves/fast_cut_kernel.h"

const acdf::LocalLoops acdf::fast_avx512 = {sample_all_fast, sample_all_fast, pdf_all_fast, pdf_all_fast};

void acdf::fast_cut_sample_avx512(const AcdfLocal* local, const AcdfLocalPoint* point, const AcdfFastCut* cut,
                                  const double (*u)[2], std::size_t count, AcdfDirectionSample* out) {
    sample_all_of_cut(*local, *point, *cut, u, count, out);
}
void acdf::fast_cut_pdf_avx512(const AcdfLocal* local, const AcdfLocalPoint* point, const AcdfFastCut* cut,
                               const float (*directions)[3], std::size_t count, float* out) {
    pdf_all_of_cut(*local, *point, *cut, directions, count, out);
}
#endif
