/* Samples and pdfs of arrays from C: acdf/batch/batch.h as symbols of the library. Arrays are those of
 * acdf/linked.h, and results are its results, bit for bit. All functions are thread-safe. */
#ifndef ACDF_BATCH_C_H
#define ACDF_BATCH_C_H

#include <stddef.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

typedef struct AcdfFile AcdfFile;
struct AcdfError;

/* Of a local environment file: batches of normals where `each` is 1, and of samples at one shading point where it
 * is more. Nothing is allocated. Returns 0, and writes nothing, where the file is of another kind or `each` is 0.
 */
int acdf_local_batch_sample(const AcdfFile* file, const float* normals, size_t each, const double* u, size_t count,
                            float* directions, float* pdfs);
int acdf_local_batch_pdf(const AcdfFile* file, const float* normals, size_t each, const float* directions,
                         size_t count, float* pdfs);

#ifdef __cplusplus
}
#endif
#endif
