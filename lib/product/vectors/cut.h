// Which vectors serve products (acdf/product/vectors.h).
#pragma once

#include <acdf/batch/batch.h>
#include <acdf/product/cut_batch.h>

#include <cstddef>

namespace acdf {

/// The functions for the best instructions that the processor has, up to `most`; null: none.
const AcdfProductVectors* product_vectors(Instructions most = Instructions::avx512) noexcept;

#if ACDF_BATCH_X86
void cut_sample_avx2(const AcdfLocal*, const AcdfLocalPoint*, const AcdfCut*, const double (*)[2], std::size_t,
                     AcdfDirectionSample*);
void cut_pdf_avx2(const AcdfLocal*, const AcdfLocalPoint*, const AcdfCut*, const float (*)[3], std::size_t, float*);
void fast_cut_sample_avx2(const AcdfLocal*, const AcdfLocalPoint*, const AcdfFastCut*, const double (*)[2],
                          std::size_t, AcdfDirectionSample*);
void fast_cut_pdf_avx2(const AcdfLocal*, const AcdfLocalPoint*, const AcdfFastCut*, const float (*)[3], std::size_t,
                       float*);
void cut_sample_avx512(const AcdfLocal*, const AcdfLocalPoint*, const AcdfCut*, const double (*)[2], std::size_t,
                       AcdfDirectionSample*);
void cut_pdf_avx512(const AcdfLocal*, const AcdfLocalPoint*, const AcdfCut*, const float (*)[3], std::size_t,
                    float*);
void fast_cut_sample_avx512(const AcdfLocal*, const AcdfLocalPoint*, const AcdfFastCut*, const double (*)[2],
                            std::size_t, AcdfDirectionSample*);
void fast_cut_pdf_avx512(const AcdfLocal*, const AcdfLocalPoint*, const AcdfFastCut*, const float (*)[3],
                         std::size_t, float*);
#endif

} // namespace acdf
