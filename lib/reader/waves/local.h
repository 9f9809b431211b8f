// The loops of LocalWavefront, which are compiled for several processors.
#pragma once

#include <acdf/local.h>

#include <cstddef>

namespace acdf {

#if ACDF_WAVEFRONT_X86
// Of files that serves_waves approves; points are such as it approves, too.
void local_sample_avx2(const AcdfLocal&, const float (*)[3], const double (*)[2], std::size_t,
                       AcdfDirectionSample*);
void local_sample_avx512(const AcdfLocal&, const float (*)[3], const double (*)[2], std::size_t,
                         AcdfDirectionSample*);
void local_sample_avx2(const AcdfLocal&, const AcdfLocalPoint&, const double (*)[2], std::size_t,
                       AcdfDirectionSample*);
void local_sample_avx512(const AcdfLocal&, const AcdfLocalPoint&, const double (*)[2], std::size_t,
                         AcdfDirectionSample*);
void local_pdf_avx2(const AcdfLocal&, const float (*)[3], const float (*)[3], std::size_t, float*);
void local_pdf_avx512(const AcdfLocal&, const float (*)[3], const float (*)[3], std::size_t, float*);
void local_pdf_avx2(const AcdfLocal&, const AcdfLocalPoint&, const float (*)[3], std::size_t, float*);
void local_pdf_avx512(const AcdfLocal&, const AcdfLocalPoint&, const float (*)[3], std::size_t, float*);
#endif

} // namespace acdf
