#if ACDF_WAVEFRONT_X86
#define ACDF_WIDTH 8
#include "local_kernel.h"

void acdf::local_sample_avx512(const AcdfLocal& local, const float (*normals)[3], const double (*u)[2],
                               std::size_t count, AcdfDirectionSample* out) {
    sample_all(local, normals, u, count, out);
}
void acdf::local_sample_avx512(const AcdfLocal& local, const AcdfLocalPoint& point, const double (*u)[2],
                               std::size_t count, AcdfDirectionSample* out) {
    sample_all(local, point, u, count, out);
}
#endif
