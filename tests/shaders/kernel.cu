// The exported C in a kernel: compiled for devices by clang, with no toolkit but these lines.
#define __CUDACC__ 1
#define __host__ __attribute__((host))
#define __device__ __attribute__((device))
#define __global__ __attribute__((global))
#pragma clang force_cuda_host_device begin
#include <math.h>
#include <stdint.h>
#include <string.h>
#pragma clang force_cuda_host_device end

#include "exported.h"

#ifdef BRDF
#define AT acdf_view(tables, directions[3], directions[4], directions[5]),
#define acdf_sample acdf_sample_brdf
#define acdf_sample_float acdf_sample_brdf_float
#define acdf_pdf acdf_pdf_brdf
#elif defined(MAPS)
#define AT acdf_sky(tables, directions[3], directions[4], directions[5]),
#define acdf_sample acdf_sample_sky
#define acdf_sample_float acdf_sample_sky_float
#define acdf_pdf acdf_pdf_sky
#else
#define AT acdf_at(tables, directions[3], directions[4], directions[5]),
#endif

__global__ void answer(const uint32_t* tables, const uint32_t* words, const float* directions, float* out) {
    const AcdfWalkSample s = acdf_sample(tables, AT words[0], words[1]);
    out[0] = s.x + s.y + s.z;
    out[1] = s.pdf + acdf_pdf(tables, AT s.x, s.y, s.z);
    out[2] = acdf_pdf(tables, AT directions[0], directions[1], directions[2]);
    out[3] = acdf_sample_float(tables, AT out[0], out[1]).pdf;
}
