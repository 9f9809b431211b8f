#if ACDF_WAVEFRONT_X86
#define ACDF_WIDTH 4
#include "waves/local_kernel.h"
#include "waves/local_piece_kernel.h"

void acdf::local_sample_avx2(const AcdfLocal& local, const float (*normals)[3], const double (*u)[2],
                             std::size_t count, AcdfDirectionSample* out) {
    sample_all(local, normals, u, count, out);
}
void acdf::local_sample_avx2(const AcdfLocal& local, const AcdfLocalPoint& point, const double (*u)[2],
                             std::size_t count, AcdfDirectionSample* out) {
    sample_all(local, point, u, count, out);
}
void acdf::local_pdf_avx2(const AcdfLocal& local, const float (*normals)[3], const float (*directions)[3],
                          std::size_t count, float* out) {
    pdf_all(local, normals, directions, count, out);
}
void acdf::local_pdf_avx2(const AcdfLocal& local, const AcdfLocalPoint& point, const float (*directions)[3],
                          std::size_t count, float* out) {
    pdf_all(local, point, directions, count, out);
}
#endif
