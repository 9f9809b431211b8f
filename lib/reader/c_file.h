// What an AcdfFile is.
#pragma once

#include <acdf/acdf.h>
#include <acdf/reader.h>

/// An open file, and the view of its kind; the others are zeros.
struct AcdfFile {
    AcdfFile(acdf::File&& from, const AcdfAllocator& memory, const AcdfBlock& place) noexcept;

    acdf::File file;
    AcdfEnvironment environment = {};
    AcdfLocal local = {};
    AcdfBrdf brdf = {};
    AcdfTable table = {};
    AcdfAllocator allocator; ///< which gave `block`, where this lies
    AcdfBlock block;
};

namespace acdf {

/// `error` may be null.
void report(const Status& status, AcdfError* error);

} // namespace acdf
