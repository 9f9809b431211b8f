// The C++ views and the product in a kernel: compiled for devices by nvcc; or by clang, with no toolkit but these
// lines.
#ifndef __NVCC__
#ifndef __HIP__ // whose compilers define __HIPCC__
#define __CUDACC__ 1
#endif
#define __host__ __attribute__((host))
#define __device__ __attribute__((device))
#define __global__ __attribute__((global))
#define __forceinline__ inline __attribute__((always_inline))
#define __noinline__ __attribute__((noinline))
#pragma clang force_cuda_host_device begin
#include <math.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>
#pragma clang force_cuda_host_device end
#endif

#include <acdf/product/product.h>
#include <acdf/visibility/visibility.h>

typedef acdf::ProductSampler<acdf::BrdfLobe> Product;

struct Scene {
    acdf::EnvironmentView sky;
    acdf::VisibleLocalView local;
    acdf::BrdfView brdf;
    acdf::TableView table;
};

__global__ void draw(const Scene* scene, const double* u, const float* normal, float* out) {
    const acdf::EnvironmentView sky = scene->sky;
    double x[6], again[2];
    acdf::DirectionSample s = sky.sample(u[0], u[1]);
    out[0] = s.pdf + sky.pdf(s.direction) + (float)sky.invert(s.direction, again);
    const acdf::LocalEnvironmentView local = scene->local.local();
    s = local.sample(normal, u[0], u[1]);
    out[1] = s.pdf + local.pdf(normal, s.direction) + (float)local.irradiance(normal);
    const AcdfVisiblePoint visible = scene->local.at(normal, normal);
    s = scene->local.sample(visible, u[0], u[1]);
    out[5] = s.pdf + scene->local.pdf(visible, s.direction);
    s = scene->brdf.sample(normal, u[0], u[1]);
    out[2] = s.pdf + scene->brdf.pdf(normal, s.direction) + (float)scene->brdf.albedo(normal);
    const Product product(scene->local.data(), acdf::BrdfLobe(scene->brdf.data()));
    const Product::Point point = product.at(normal, normal);
    s = product.sample(point, u[0], u[1]);
    out[3] = s.pdf + product.pdf(point, s.direction);
    out[4] = (float)(scene->table.sample(0, u, x) + scene->table.pdf(0, x));
}
