// The qualifier of C++ functions that are called in kernels: that of CUDA and HIP, or another one.
#pragma once

#ifndef ACDF_METHOD
#if defined(__CUDACC__) || defined(__HIPCC__)
#define ACDF_METHOD __host__ __device__
#else
#define ACDF_METHOD
#endif
#endif

// Of what is inlined wherever it is called: what is returned by a call goes through memory
// (acdf_environment_sample).
#if defined(__GNUC__) && !defined(__CUDACC__) && !defined(__HIPCC__) && !defined(__SYCL_DEVICE_ONLY__)
#define ACDF_INLINE_METHOD ACDF_METHOD __attribute__((always_inline))
#else
#define ACDF_INLINE_METHOD ACDF_METHOD
#endif
