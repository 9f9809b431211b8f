// What a device answers by the exported functions (acdf/shader/walk.h, acdf/shader/brdf.h), beside the reader.
#pragma once

#include <acdf/reader.h>
#include <acdf/views.h>

#include <cstddef>
#include <string>

namespace acdf_test {

/// Prints how nearly samples.bin and pdfs.bin of `folder` agree with the reader, and returns 0, or 1 where
/// they do not. `ulps`: by how many steps of 2^-24 of it the pdf that a device returns for its own sample may
/// differ.
int check(const acdf::File& file, std::size_t count, const std::string& folder, double ulps);

} // namespace acdf_test
