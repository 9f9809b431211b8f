// Memory of a GPU.
#pragma once

#include <cuda_runtime.h>

#include <cstddef>
#include <cstdio>
#include <cstdlib>

namespace acdf_cuda {

inline void require(cudaError_t error, const char* what) {
    if (error == cudaSuccess) return;
    std::fprintf(stderr, "CUDA: %s: %s\n", what, cudaGetErrorString(error));
    std::exit(1);
}

/// Bytes in the memory of the device.
template <class T>
class DeviceArray {
public:
    explicit DeviceArray(std::size_t count) { require(cudaMalloc(&data_, count * sizeof(T)), "memory"); }
    DeviceArray(const T* from, std::size_t count) : DeviceArray(count) {
        require(cudaMemcpy(data_, from, count * sizeof(T), cudaMemcpyHostToDevice), "copy");
    }
    ~DeviceArray() { cudaFree(data_); }
    DeviceArray(const DeviceArray&) = delete;
    DeviceArray& operator=(const DeviceArray&) = delete;
    T* data() const { return static_cast<T*>(data_); }

private:
    void* data_ = nullptr;
};

} // namespace acdf_cuda
