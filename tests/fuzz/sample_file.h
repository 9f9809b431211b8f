// Everything that a program may do with a file that was accepted.
#pragma once

#include <acdf/reader.h>
#include <acdf/views.h>

#include <cstddef>

namespace acdf_test {

/// Samples, evaluates and inverts with random numbers, directions, normals, views and indices of any kind, in C++
/// and in C, one call at a time and in batches. `bytes`: what the file was read from. Aborts where a promise of
/// acdf/reader.h breaks.
void sample_everything(const acdf::File& file, const void* bytes, std::size_t size);

} // namespace acdf_test
