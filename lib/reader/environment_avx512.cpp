#if ACDF_WAVEFRONT_X86
#define ACDF_WIDTH 8
#include "environment_kernel.h"

void acdf::environment_sample_avx512(const AcdfEnvironment& environment, const double (*u)[2], std::size_t count,
                                     AcdfDirectionSample* out) {
    sample_all(environment, u, count, out);
}
void acdf::environment_pdf_avx512(const AcdfEnvironment& environment, const float (*directions)[3],
                                  std::size_t count, float* out) {
    pdf_all(environment, directions, count, out);
}
#endif
