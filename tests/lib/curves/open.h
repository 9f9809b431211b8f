// Files of curves as tests open them: by the interface in C, and what is in chunk TREE.
#pragma once

#include <acdf/curves/curves.h>
#include <acdf/curves/tree.h>

namespace acdf_test {

/// Chunk TREE of an open file.
struct TreeOf {
    std::uint32_t units = 0; ///< of two bytes
    const std::uint8_t* data;

    explicit TreeOf(const acdf::File& file) : data(acdf_curves_tree(file.get(), &units)) {}
};

/// acdf_open and acdf_from_memory of files of every fit.
inline AcdfFile* open_in_c(const char* path, AcdfError* error = nullptr) {
    AcdfLoadOptions options = {};
    options.curves = acdf_curves();
    return acdf_open_with(path, &options, error);
}
inline AcdfFile* from_memory_in_c(const void* data, std::size_t size, AcdfError* error = nullptr, int plain = 0) {
    AcdfLoadOptions options = {};
    options.curves = acdf_curves();
    options.plain = plain;
    return acdf_from_memory_with(data, size, &options, error);
}

} // namespace acdf_test
