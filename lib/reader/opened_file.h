// What an open file is, of the C++ interface and of that in C. Not installed.
#pragma once

#include "check/check.h"

#include <acdf/acdf.h>
#include <acdf/reader.h>

/// Plain data: views and the memory that they point into. The view of another kind than the file's is zeros.
struct AcdfFile : acdf::Contents {
    const std::uint8_t* bytes;
    std::uint64_t size;
    AcdfEnvironment environment;
#ifndef ACDF_ENVIRONMENT_ONLY
    AcdfLocal local;
    AcdfBrdf brdf;
    AcdfTable table;
    const AcdfNormalRows* rows; ///< of normals or views; null: none
#endif
    AcdfAllocator allocator; ///< which gave what follows
    AcdfBlock own;           ///< where this lies
    AcdfBlock memory[4];     ///< the file's bytes; inflated chunks; runtime tables; those of rows of halvings

    std::uint64_t table_bytes() const { return std::uint64_t{memory[2].bytes} + memory[3].bytes; }
    /// Whether there are curves instead of halvings.
    bool curves() const { return payloads.of[acdf::chunk_halvings].data == nullptr; }
    AcdfKind kind() const { return static_cast<AcdfKind>(reinterpret_cast<const AcdfHeader*>(bytes)->kind); }
};

namespace acdf {

/// Sets what an environment has of the axes and the description of a file.
void set_grid(const Parts& parts, AcdfEnvironment& environment) noexcept;

/// A FindingSink: `status`, an AcdfError, becomes that of the first error.
bool first_error(const Finding& finding, void* status);

#ifndef ACDF_ENVIRONMENT_ONLY
/// The view of a kind that is not an environment.
void make_view(const Parts& parts, AcdfFile& file) noexcept;
#endif

} // namespace acdf
