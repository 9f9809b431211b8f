/* Several samples and pdfs of products at once by vectors of the processor. Valid C99, C++17 and CUDA/HIP/SYCL. */
#ifndef ACDF_PRODUCT_VECTORS_H
#define ACDF_PRODUCT_VECTORS_H

#include <acdf/product/cut.h>
#include <acdf/product/fast_cut.h>

#ifdef __cplusplus
extern "C" {
#endif

/* The results are those of single calls, bit for bit. Cuts have parts, and points are such as acdf_cut_by_vectors
 * approves. */
typedef struct AcdfProductVectors {
    void (*cut_sample)(const AcdfLocal* local, const AcdfLocalPoint* point, const AcdfCut* cut,
                       const double (*u)[2], size_t count, AcdfDirectionSample* out);
    void (*cut_pdf)(const AcdfLocal* local, const AcdfLocalPoint* point, const AcdfCut* cut,
                    const float (*directions)[3], size_t count, float* out);
    void (*fast_cut_sample)(const AcdfLocal* local, const AcdfLocalPoint* point, const AcdfFastCut* cut,
                            const double (*u)[2], size_t count, AcdfDirectionSample* out);
    void (*fast_cut_pdf)(const AcdfLocal* local, const AcdfLocalPoint* point, const AcdfFastCut* cut,
                         const float (*directions)[3], size_t count, float* out);
} AcdfProductVectors;

/* The functions that the linked library acdf-product has for this processor; null: none. */
const AcdfProductVectors* acdf_product_vectors(void);

#ifdef __cplusplus
}
#endif
#endif
