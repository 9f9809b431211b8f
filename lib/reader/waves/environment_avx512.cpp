#if ACDF_WAVEFRONT_X86
#define ACDF_WIDTH 8
#include "waves/environment_kernel.h"
#include "waves/group_kernel.h"

void acdf::environment_sample_avx512(const AcdfEnvironment& environment, const double (*u)[2], std::size_t count,
                                     AcdfDirectionSample* out) {
    if (environment.cells) sample_by_cells(environment, u, count, out);
    else sample_by_groups(environment, u, count, out);
}
void acdf::environment_pdf_avx512(const AcdfEnvironment& environment, const float (*directions)[3],
                                  std::size_t count, float* out) {
    if (environment.cells) pdf_by_cells(environment, directions, count, out);
    else pdf_by_groups(environment, directions, count, out);
}
#endif
