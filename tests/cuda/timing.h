// Time of calls on a GPU: several million a launch, one a thread, by the device's own clock. Least of several.
#pragma once

#include "device_array.h"

#include <algorithm>
#include <limits>

namespace acdf_cuda {

constexpr unsigned kCalls = 1u << 23, kThreads = 128;

/// Results are summed, so that none is left out.
template <class Call>
__global__ void __launch_bounds__(kThreads) call_all(Call call, float* sums) {
    const unsigned i = blockIdx.x * kThreads + threadIdx.x;
    float sum = call(i);
    for (int step = 16; step > 0; step /= 2) sum += __shfl_down_sync(0xFFFFFFFFu, sum, step);
    if (threadIdx.x % 32 == 0) atomicAdd(&sums[i / 32 % 4096], sum);
}

/// What a kernel takes of a multiprocessor.
struct Kernel {
    int registers = 0, stack = 0; ///< words, and bytes of local memory, a thread
    int warps = 0;                ///< of 64 that may be resident at once
};

/// A time, and why it is that.
struct Timed {
    double ns = 0.0; ///< a call
    Kernel kernel;
};

template <class Call>
Timed time(const Call& call, unsigned calls_a_thread = 1) {
    static const DeviceArray<float> sums(4096);
    cudaEvent_t begin, end;
    require(cudaEventCreate(&begin), "event");
    require(cudaEventCreate(&end), "event");
    float least = std::numeric_limits<float>::infinity();
    for (int i = 0; i < 24; ++i) {
        require(cudaEventRecord(begin), "event");
        call_all<<<kCalls / kThreads, kThreads>>>(call, sums.data());
        require(cudaGetLastError(), "kernel");
        require(cudaEventRecord(end), "event");
        require(cudaEventSynchronize(end), "kernel");
        float milliseconds;
        require(cudaEventElapsedTime(&milliseconds, begin, end), "event");
        if (i >= 4) least = std::min(least, milliseconds);
    }
    cudaEventDestroy(begin);
    cudaEventDestroy(end);
    Timed out;
    out.ns = double{least} * 1e6 / kCalls / calls_a_thread;
    cudaFuncAttributes attributes;
    int blocks = 0;
    require(cudaFuncGetAttributes(&attributes, call_all<Call>), "kernel");
    require(cudaOccupancyMaxActiveBlocksPerMultiprocessor(&blocks, call_all<Call>, kThreads, 0), "kernel");
    out.kernel = {attributes.numRegs, static_cast<int>(attributes.localSizeBytes),
                  blocks * static_cast<int>(kThreads / 32)};
    return out;
}

/// What is asked: numbers, directions and normals, of each call.
struct Asked {
    const float2* numbers;
    const float4 *directions, *normals;

    __device__ void direction(unsigned i, float out[3]) const { three(directions[i], out); }
    __device__ void normal(unsigned i, float out[3]) const { three(normals[i], out); }

private:
    __device__ static void three(const float4& from, float out[3]) {
        out[0] = from.x;
        out[1] = from.y;
        out[2] = from.z;
    }
};

} // namespace acdf_cuda
