/* Samples and pdfs of arrays from C: acdf/batch/batch.h as symbols of the library. Arrays, arguments and results
 * are those of the functions of acdf/linked.h that end in _array instead, bit for bit, and take a fraction of the
 * time. All functions are thread-safe and allocate nothing. */
#ifndef ACDF_BATCH_C_H
#define ACDF_BATCH_C_H

#include <stddef.h>

#ifdef __cplusplus
extern "C" {
#endif

typedef struct AcdfFile AcdfFile;

/* acdf_sample_environment_array. */
int acdf_sample_environment_batch(const AcdfFile* file, const double* u, size_t count, float* directions,
                                  float* pdfs);
/* acdf_pdf_environment_array. */
int acdf_pdf_environment_batch(const AcdfFile* file, const float* directions, size_t count, float* pdfs);

/* acdf_sample_local_array. */
int acdf_sample_local_batch(const AcdfFile* file, const float* normals, size_t each, const double* u, size_t count,
                            float* directions, float* pdfs);
/* acdf_pdf_local_array. */
int acdf_pdf_local_batch(const AcdfFile* file, const float* normals, size_t each, const float* directions,
                         size_t count, float* pdfs);

/* acdf_sample_brdf_array. */
int acdf_sample_brdf_batch(const AcdfFile* file, const float* wo, size_t each, const double* u, size_t count,
                           float* wi, float* pdfs);
/* acdf_pdf_brdf_array. */
int acdf_pdf_brdf_batch(const AcdfFile* file, const float* wo, size_t each, const float* wi, size_t count,
                        float* pdfs);

#ifdef __cplusplus
}
#endif
#endif
