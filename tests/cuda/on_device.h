// An open file's memory on a GPU, and its views there. What a renderer does that has CUDA.
#pragma once

#include "device_array.h"
#include "moved_views.h"

#include <acdf/reader.h>
#include <acdf/visibility/visibility_c.h>

namespace acdf_cuda {

/// A copy of all that a file's views point into. They are kernels' parameters by value, valid while this lives; the
/// file may be closed.
class DeviceFile {
public:
    explicit DeviceFile(const acdf::File& file) : count_(acdf_visible_memory(file.get(), moves_)) {
        for (int i = 0; i < count_; ++i) {
            void* to = nullptr;
            require(cudaMalloc(&to, moves_[i].bytes + 3), "memory");
            require(cudaMemcpy(to, moves_[i].from, moves_[i].bytes, cudaMemcpyHostToDevice), "copy");
            moves_[i].to = to;
        }
    }
    ~DeviceFile() {
        for (int i = 0; i < count_; ++i) cudaFree(const_cast<void*>(moves_[i].to));
    }
    DeviceFile(const DeviceFile&) = delete;
    DeviceFile& operator=(const DeviceFile&) = delete;

    template <class View>
    View operator()(const View& view) const {
        return acdf_test::moved(view, moves_, count_);
    }

private:
    AcdfMove moves_[ACDF_MAX_VISIBLE_MOVES];
    int count_;
};

} // namespace acdf_cuda
