// The loops of EnvironmentWavefront, which are compiled for several processors.
#pragma once

#include <acdf/sample.h>
#include <acdf/wavefront.h>

#include <cstddef>

namespace acdf {

#if ACDF_WAVEFRONT_X86
// Of environments that have runtime tables.
void environment_sample_avx2(const AcdfEnvironment&, const double (*)[2], std::size_t, AcdfDirectionSample*);
void environment_sample_avx512(const AcdfEnvironment&, const double (*)[2], std::size_t, AcdfDirectionSample*);
void environment_pdf_avx2(const AcdfEnvironment&, const float (*)[3], std::size_t, float*);
void environment_pdf_avx512(const AcdfEnvironment&, const float (*)[3], std::size_t, float*);
#endif

} // namespace acdf
